// EnergyPlus weather files (.epw).
#pragma once

#include <filesystem>
#include <vector>

#include "photile/light_options.hpp"
#include "weather/perez_sky.hpp"

namespace photile::weather {

/// One hour of a typical year.
struct WeatherHour {
  int month = 1, day = 1;
  double hour = 0.5;  ///< the middle of the hour, standard time
  SkyIrradiance irradiance;
};

struct WeatherYear {
  Site site;
  std::vector<WeatherHour> hours;  ///< 8,760, or 8,784 of a leap year
  /// The first day of the file, 0 = Monday; Sunday where the file names none.
  int first_weekday = 6;
};

/// Reads the site, and of each hour the direct normal and diffuse horizontal irradiance and the
/// dew point. The middle of an hour is half an hour before the time that the file gives it.
/// Errors: InputError naming the file, the line, what was found and the remedy.
WeatherYear read_weather(const std::filesystem::path& file);

/// Reads a file that may have fewer hours than a year, or none.
WeatherYear read_weather_hours(const std::filesystem::path& file);

/// The hour of the file in which a moment falls, whatever its year.
const WeatherHour& hour_at(const WeatherYear& year, const LocalTime& time);

}  // namespace photile::weather
