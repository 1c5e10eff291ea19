#include "weather/weather_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::weather {
namespace {

constexpr std::size_t header_lines = 8;
constexpr std::size_t hours_of_year = 8'760, hours_of_leap_year = 8'784;
constexpr std::size_t fields_of_hour = 35;
constexpr std::size_t periods_line = 7, weekday_field = 4;
constexpr std::array<const char*, 7> weekdays{"monday", "tuesday",  "wednesday", "thursday",
                                              "friday", "saturday", "sunday"};
constexpr double missing_irradiance = 9'999, missing_temperature = 99.9;

/// Days of each month; the 29th of February is one where a file has it.
constexpr std::array<int, 12> days_of_month{31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

/// A line of the file, cut at its commas.
class Line {
 public:
  Line(const std::filesystem::path& file, std::size_t number, std::string_view text)
      : file_(file), number_(number) {
    for (bool more = true; more;) {
      const std::size_t comma = text.find(',');
      fields_.push_back(trimmed(text.substr(0, comma)));
      more = comma != std::string_view::npos;
      if (more) text.remove_prefix(comma + 1);
    }
  }

  std::size_t fields() const { return fields_.size(); }

  std::string_view field(std::size_t index) const {
    return index < fields_.size() ? fields_[index] : std::string_view();
  }

  /// Errors: InputError.
  double number(std::size_t index, const char* what, double lowest, double highest) const {
    const auto value = parse_signed(field(index));
    if (!value || *value < lowest || *value > highest) {
      refuse(fmt::format("field {} is '{}', no {} from {:g} to {:g}", index + 1, field(index), what,
                         lowest, highest));
    }
    return *value;
  }

  /// Errors: InputError.
  double irradiance(std::size_t index, const char* what) const {
    const double value = number(index, what, 0, limits::max_irradiance);
    if (value >= missing_irradiance) refuse(fmt::format("the {} is missing", what));
    return value;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}; mend the line, or take another EPW file",
                                 file_.string(), number_, what));
  }

 private:
  const std::filesystem::path& file_;
  std::size_t number_;
  std::vector<std::string_view> fields_;
};

Site site_of(const Line& line) {
  if (lower(line.field(0)) != "location") line.refuse("an EPW file begins with LOCATION");
  return {line.number(6, "latitude", -90, 90), line.number(7, "longitude", -180, 180),
          line.number(8, "time zone", -12, 14)};
}

WeatherHour hour_of(const Line& line) {
  if (line.fields() > fields_of_hour) {
    line.refuse(fmt::format("{} fields, where an hour has {}: numbers need a decimal point",
                            line.fields(), fields_of_hour));
  }
  WeatherHour hour;
  hour.month = static_cast<int>(line.number(1, "month", 1, 12));
  hour.day = static_cast<int>(line.number(2, "day of this month", 1,
                                          days_of_month[static_cast<std::size_t>(hour.month - 1)]));
  hour.hour = line.number(3, "hour", 1, 24) - 0.5;
  hour.irradiance.direct_normal = line.irradiance(14, "direct normal irradiance");
  hour.irradiance.diffuse_horizontal = line.irradiance(15, "diffuse horizontal irradiance");
  const double dew_point = line.number(7, "dew point", -100, 100);
  if (dew_point < missing_temperature) hour.irradiance.dew_point = dew_point;
  return hour;
}

}  // namespace

WeatherYear read_weather_hours(const std::filesystem::path& file) {
  const std::string text = read_input_text(file);
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.size() <= header_lines) {
    throw InputError(
        fmt::format("{}: {} lines, where an EPW file has {} before its hours; give an "
                    "EPW file",
                    file.string(), lines.size(), header_lines));
  }
  WeatherYear year;
  year.site = site_of(Line(file, 1, lines.front()));
  const std::string weekday =
      lower(Line(file, periods_line + 1, lines[periods_line]).field(weekday_field));
  const auto day = std::find(weekdays.begin(), weekdays.end(), weekday);
  if (day != weekdays.end()) year.first_weekday = static_cast<int>(day - weekdays.begin());
  for (std::size_t i = header_lines; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    year.hours.push_back(hour_of(Line(file, i + 1, lines[i])));
    if (year.hours.size() > hours_of_leap_year) {
      throw InputError(
          fmt::format("{}: line {}: more than {} hours; give a file of one year with a "
                      "line for each hour",
                      file.string(), i + 1, hours_of_leap_year));
    }
  }
  return year;
}

WeatherYear read_weather(const std::filesystem::path& file) {
  WeatherYear year = read_weather_hours(file);
  if (year.hours.size() != hours_of_year && year.hours.size() != hours_of_leap_year) {
    throw InputError(fmt::format(
        "{}: {} hours; give a file of a whole year, {} or {} lines after "
        "the first {}",
        file.string(), year.hours.size(), hours_of_year, hours_of_leap_year, header_lines));
  }
  return year;
}

const WeatherHour& hour_at(const WeatherYear& year, const LocalTime& time) {
  const WeatherHour* nearest = &year.hours.front();
  const auto distance = [&](const WeatherHour& hour) {
    return 24 * 31 * std::abs(hour.month - time.month) + 24 * std::abs(hour.day - time.day) +
           std::abs(hour.hour - time.hour);
  };
  for (const WeatherHour& hour : year.hours) {
    if (distance(hour) < distance(*nearest)) nearest = &hour;
  }
  return *nearest;
}

LocalTime middle_of(const WeatherHour& hour, const LocalTime& asked) {
  LocalTime middle = asked;
  middle.hour = hour.hour;
  return middle;
}

}  // namespace photile::weather
