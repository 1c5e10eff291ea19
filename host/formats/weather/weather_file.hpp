// EnergyPlus weather files (.epw).
#pragma once

#include <filesystem>
#include <vector>

#include "photile/load_scene.hpp"
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

/// The row of the file that covers a moment, whatever its year: the row of hour h covers what comes
/// after h - 1 o'clock, up to h itself.
const WeatherHour& hour_at(const WeatherYear& year, const LocalTime& time);

/// The moment whose sun goes with a row: the middle of its hour, on the day that is asked for. What
/// a station measures over an hour is not the light of a sun half an hour higher or lower.
LocalTime middle_of(const WeatherHour& hour, const LocalTime& asked);

}  // namespace photile::weather
