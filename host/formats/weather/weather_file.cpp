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

namespace photile::weather {
namespace {

constexpr std::size_t header_lines = 8;
constexpr std::size_t hours_of_year = 8'760, hours_of_leap_year = 8'784;
constexpr std::size_t fields_of_hour = 35;
constexpr std::size_t periods_line = 7, first_day_field = 5;
constexpr std::array<const char*, 7> weekdays{"monday", "tuesday",  "wednesday", "thursday",
                                              "friday", "saturday", "sunday"};
constexpr double missing_irradiance = 9'999, missing_temperature = 99.9;
/// Of the sun at its nearest, outside the atmosphere, and a little (ASTM E490).
constexpr double most_irradiance = 1'500;

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
      refuse(fmt::format("field {} is '{}'; the {} must be a number from {:g} to {:g}", index + 1,
                         field(index), what, lowest, highest));
    }
    return *value;
  }

  /// Errors: InputError.
  double irradiance(std::size_t index, const char* what) const {
    const double value = number(index, what, 0, 10 * missing_irradiance + 9);
    if (value >= missing_irradiance) refuse(fmt::format("the {} is missing", what));
    if (value > most_irradiance) {
      refuse(fmt::format("the {} of {:g} W/m2 exceeds that of the sun above the atmosphere", what,
                         value));
    }
    return value;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}; correct the line, or give another EPW file",
                                 file_.string(), number_, what));
  }

 private:
  const std::filesystem::path& file_;
  std::size_t number_;
  std::vector<std::string_view> fields_;
};

Site site_of(const Line& line) {
  if (lower(line.field(0)) != "location") line.refuse("an EPW file begins with LOCATION");
  const Site site{line.number(6, "latitude", -90, 90), line.number(7, "longitude", -180, 180),
                  line.number(8, "time zone", -12, 14)};
  // Clock time differs from solar time by at most three and a half hours; with a wrong sign it
  // differs by more.
  constexpr double most_hours = 5, degrees_per_hour = 15;
  const double apart =
      std::remainder(site.time_zone - site.longitude_degrees / degrees_per_hour, 24.0);
  if (std::abs(apart) > most_hours) {
    line.refuse(fmt::format("time zone {:g} is {:.1f} hours from the sun at longitude {:g}",
                            site.time_zone, std::abs(apart), site.longitude_degrees));
  }
  return site;
}

/// A day of any year.
struct Day {
  int month = 0, day = 0;
  bool operator==(const Day&) const = default;
};

/// Of "12/31", with blanks before its numbers; with a year behind it where the file has one.
Day day_of(const Line& line, std::size_t index) {
  const std::string_view text = line.field(index);
  const std::size_t slash = text.find('/');
  const auto month = parse_number<int>(trimmed(text.substr(0, slash)));
  std::string_view rest = slash == std::string_view::npos ? "" : text.substr(slash + 1);
  const auto day = parse_number<int>(trimmed(rest.substr(0, rest.find('/'))));
  if (!month || !day)
    line.refuse(fmt::format("field {} is '{}', not a date of the form month/day", index + 1, text));
  return {*month, *day};
}

/// The description of the following lines in DATA PERIODS.
struct Period {
  Day first, last;
  int first_weekday = WeatherYear().first_weekday;
};

Period period_of(const Line& line) {
  constexpr std::size_t periods = 1, records = 2, weekday = 4;
  if (lower(line.field(0)) != "data periods") line.refuse("DATA PERIODS is missing");
  if (line.number(periods, "number of data periods", 1, 366) != 1) {
    line.refuse(
        fmt::format("there are {} data periods; only one is supported", line.field(periods)));
  }
  if (line.number(records, "number of records per hour", 1, 60) != 1) {
    line.refuse(
        fmt::format("there are {} records per hour; only one is supported", line.field(records)));
  }
  Period period{day_of(line, first_day_field), day_of(line, first_day_field + 1)};
  const auto* const named = std::find(weekdays.begin(), weekdays.end(), lower(line.field(weekday)));
  if (named != weekdays.end()) period.first_weekday = static_cast<int>(named - weekdays.begin());
  return period;
}

/// The day and hour after those of a line: the 29th of February is one that a file may have.
bool follows(const WeatherHour& hour, const WeatherHour& before) {
  if (hour.month == before.month && hour.day == before.day) return hour.hour == before.hour + 1;
  constexpr double first = 0.5, last = 23.5;
  if (before.hour != last || hour.hour != first) return false;
  if (hour.month == before.month) return hour.day == before.day + 1;
  const bool ends = before.day == days_of_month[static_cast<std::size_t>(before.month - 1)] ||
                    (before.month == 2 && before.day == 28);
  return ends && hour.day == 1 && hour.month == before.month % 12 + 1;
}

WeatherHour hour_of(const Line& line) {
  if (line.fields() > fields_of_hour) {
    line.refuse(fmt::format("{} fields instead of {} (numbers need a decimal point)", line.fields(),
                            fields_of_hour));
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
    throw InputError(fmt::format(
        "{}: the file has {} lines, and an EPW file has {} before its hours; give an EPW file",
        file.string(), lines.size(), header_lines));
  }
  WeatherYear year;
  year.site = site_of(Line(file, 1, lines.front()));
  const Line periods(file, periods_line + 1, lines[periods_line]);
  const Period period = period_of(periods);
  year.first_weekday = period.first_weekday;
  const auto is_day = [](const WeatherHour& hour, const Day& day) {
    return Day{hour.month, hour.day} == day;
  };
  for (std::size_t i = header_lines; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    const Line line(file, i + 1, lines[i]);
    const WeatherHour hour = hour_of(line);
    if (!year.hours.empty() && !follows(hour, year.hours.back())) {
      const WeatherHour& before = year.hours.back();
      line.refuse(fmt::format("hour {:g} of {}/{} does not follow hour {:g} of {}/{}",
                              hour.hour + 0.5, hour.month, hour.day, before.hour + 0.5,
                              before.month, before.day));
    }
    year.hours.push_back(hour);
    if (year.hours.size() > hours_of_leap_year) {
      throw InputError(
          fmt::format("{}: line {}: more than {} hours; give a file of one year with a "
                      "line for each hour",
                      file.string(), i + 1, hours_of_leap_year));
    }
  }
  const bool whole = year.hours.size() == hours_of_year || year.hours.size() == hours_of_leap_year;
  if (whole &&
      !(is_day(year.hours.front(), period.first) && is_day(year.hours.back(), period.last))) {
    periods.refuse(fmt::format("the data period {} to {} is not that of the hours, {}/{} to {}/{}",
                               periods.field(first_day_field), periods.field(first_day_field + 1),
                               year.hours.front().month, year.hours.front().day,
                               year.hours.back().month, year.hours.back().day));
  }
  return year;
}

WeatherYear read_weather(const std::filesystem::path& file) {
  const WeatherYear year = read_weather_hours(file);
  if (year.hours.size() != hours_of_year && year.hours.size() != hours_of_leap_year) {
    throw InputError(fmt::format(
        "{}: the file has {} hours; give a file of a whole year, {} or {} lines after "
        "the first {}",
        file.string(), year.hours.size(), hours_of_year, hours_of_leap_year, header_lines));
  }
  const bool is_leap = std::any_of(year.hours.begin(), year.hours.end(), [](const auto& hour) {
    return hour.month == 2 && hour.day == 29;
  });
  if (is_leap != (year.hours.size() == hours_of_leap_year)) {
    throw InputError(
        fmt::format("{}: the file has {} hours {} the 29th of February; give a file of one year",
                    file.string(), year.hours.size(), is_leap ? "with" : "without"));
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
