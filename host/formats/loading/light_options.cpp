#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/load_scene.hpp"
#include "photometry/photometric_file.hpp"
#include "weather/sky_patches.hpp"

namespace photile {
namespace {

/// The two sides of an '='. Errors: UsageError with the remedy.
std::pair<std::string, std::string> sides(const std::string& text, std::size_t equals,
                                          const char* remedy) {
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(fmt::format("'{}': {}", text, remedy));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// The numbers between commas; nothing if one is none.
std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const auto value = parse_signed(text.substr(0, comma));
    if (!value) return std::nullopt;
    numbers.push_back(*value);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return numbers;
}

}  // namespace

MaterialShare MaterialShare::parse(const std::string& text) {
  const auto [glob, value] =
      sides(text, text.rfind('='), "use MATERIAL=SHARE, such as 'wall*=0.5' or wall=50%");
  const bool percent = value.ends_with('%');
  const auto number = parse_signed(percent ? value.substr(0, value.size() - 1) : value);
  const double share = number.value_or(-1) / (percent ? 100 : 1);
  if (!(share >= 0 && share <= 1)) {
    throw UsageError(
        fmt::format("'{}': a share is a number from 0 to 1, or from 0% to 100%", text));
  }
  return {glob, share};
}

LightProfile LightProfile::parse(const std::string& text) {
  const auto [light, file] =
      sides(text, text.find('='), "use NAME=FILE, a light and a photometric file (.ies or .ldt)");
  return {light, file};
}

Site Site::parse(const std::string& text) {
  const auto numbers = numbers_of(text);
  if (!numbers || numbers->size() != 3 || std::abs((*numbers)[0]) > 90.0 ||
      std::abs((*numbers)[1]) > 180.0 || (*numbers)[2] < -12.0 || (*numbers)[2] > 14.0) {
    throw UsageError(fmt::format(
        "site '{}': use LATITUDE,LONGITUDE,TIME_ZONE, such as 52.5,13.4,1: degrees north from -90 "
        "to 90, degrees east from -180 to 180, hours ahead of UTC from -12 to 14",
        text));
  }
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

LocalTime LocalTime::parse(const std::string& text) {
  const auto part = [&](std::size_t first, std::size_t count) {
    const auto value = parse_number<int>(std::string_view(text).substr(first, count));
    return value && *value >= 0 ? *value : -1;
  };
  if (text.size() == 16 && text[4] == '-' && text[7] == '-' && text[10] == 'T' && text[13] == ':') {
    const int year = part(0, 4), month = part(5, 2), day = part(8, 2), hour = part(11, 2),
              minute = part(14, 2);
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (year > 0 && date.ok() && hour >= 0 && hour < 24 && minute >= 0 && minute < 60)
      return {year, month, day, hour + minute / 60.0};
  }
  throw UsageError(fmt::format(
      "time '{}': use YYYY-MM-DDTHH:MM, such as 2026-06-21T14:00, in the site's standard time",
      text));
}

Sun Sun::parse(const std::string& text) {
  const auto numbers = numbers_of(text);
  if (numbers && numbers->size() == 1 && numbers->front() > 0.0) {
    Sun sun{0, 0, numbers->front()};
    sun.placed_by_time = true;
    return sun;
  }
  if (!numbers || numbers->size() < 3 || numbers->size() > 4) {
    throw UsageError(fmt::format(
        "sun '{}': use AZIMUTH,ELEVATION,LUX[,DIAMETER], such as 135,40,80000: degrees clockwise "
        "from north, degrees above the horizon, lux on a surface facing the sun, diameter of its "
        "disc in degrees; or only LUX if a site and a time are given",
        text));
  }
  Sun sun{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  if (numbers->size() == 4) sun.diameter_degrees = (*numbers)[3];
  if (std::abs(sun.azimuth_degrees) > 360.0 || std::abs(sun.elevation_degrees) > 90.0 ||
      !(sun.illuminance > 0.0) || sun.diameter_degrees < 0.0 ||
      sun.diameter_degrees > limits::max_sun_diameter_degrees) {
    throw UsageError(
        fmt::format("sun '{}': the azimuth must lie between -360 and 360 degrees, the elevation "
                    "between -90 and 90, the lux above 0 and the diameter between 0 and {} degrees",
                    text, limits::max_sun_diameter_degrees));
  }
  return sun;
}

Sky Sky::parse(const std::string& text) {
  constexpr const char* remedy =
      "use KIND=LUX, such as overcast=10000; the kinds are uniform, overcast and clear; or "
      "perez=DIRECT,DIFFUSE, such as perez=600,120, in W/m2 on a surface facing the sun and on "
      "open ground; or "
      "patches=145, 577 or 2305";
  constexpr std::array kinds{std::pair{"uniform", SkyKind::uniform},
                             std::pair{"overcast", SkyKind::overcast},
                             std::pair{"clear", SkyKind::clear}};
  const auto [kind, lux] = sides(text, text.find('='), remedy);
  const auto illuminance = parse_signed(lux);
  if (kind == "perez") {
    const auto numbers = numbers_of(lux);
    const auto in_range = [](double value) {
      return value >= 0.0 && value <= limits::max_irradiance;
    };
    if (numbers && numbers->size() == 2 && in_range((*numbers)[0]) && in_range((*numbers)[1]))
      return {SkyKind::perez, 0, (*numbers)[0], (*numbers)[1]};
  }
  if (kind == "patches" && illuminance) {
    for (const int count : weather::patch_counts) {
      if (*illuminance == count) return {SkyKind::patches, 0, 0, 0, count};
    }
  }
  for (const auto& [word, value] : kinds) {
    if (kind == word && illuminance && *illuminance > 0.0) return {value, *illuminance};
  }
  throw UsageError(fmt::format("sky '{}': {}", text, remedy));
}

LuminousPanel LuminousPanel::parse(const std::string& text) {
  constexpr const char* remedy =
      "use NAME=WxH,LUMENS, such as Area.001=1.2x0.6,3000: a node, metres and lumens";
  const auto [node, size] = sides(text, text.rfind('='), remedy);
  const std::size_t cross = size.find('x');
  const auto width = parse_signed(std::string_view(size).substr(0, cross));
  const auto rest = cross == std::string::npos
                        ? std::nullopt
                        : numbers_of(std::string_view(size).substr(cross + 1));
  if (!width || !rest || rest->size() != 2 || !(*width > 0.0) || !((*rest)[0] > 0.0) ||
      !((*rest)[1] > 0.0)) {
    throw UsageError(fmt::format("area light '{}': {}", text, remedy));
  }
  return {node, *width, (*rest)[0], (*rest)[1]};
}

LightTemperature LightTemperature::parse(const std::string& text) {
  constexpr const char* remedy = "use NAME=KELVIN, such as desk_lamp=2700";
  const auto [light, value] = sides(text, text.rfind('='), remedy);
  std::string_view digits = value;
  if (digits.ends_with('K')) digits.remove_suffix(1);
  const auto kelvin = parse_signed(digits);
  if (!kelvin) throw UsageError(fmt::format("light temperature '{}': {}", text, remedy));
  if (*kelvin < limits::min_color_temperature || *kelvin > limits::max_color_temperature) {
    throw UsageError(fmt::format("light temperature '{}': give a number from {} to {} kelvin", text,
                                 limits::min_color_temperature, limits::max_color_temperature));
  }
  return {light, *kelvin};
}

}  // namespace photile
