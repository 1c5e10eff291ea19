// The figures of standards for a year of daylight, over the hours in which a room is used.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "daylight/annual_daylight.hpp"

namespace photile::daylight {

/// Hours of some days of each week, in standard time, or those of a file.
struct Occupancy {
  double from = 8, to = 18;
  std::array<bool, 7> days{true, true, true, true, true, true, true};  ///< from Monday on
  std::filesystem::path schedule;                                      ///< "" = none

  /// Reads "8-18". Errors: UsageError.
  void set_hours(const std::string& text);
  /// Reads "mon-fri", "mon,wed,fri", "fri-mon". Errors: UsageError.
  void set_days(const std::string& text);
};

/// The hours of a schedule's file are occupied where their value is more than 0: a line for each
/// hour of the year, whose last field is the value, and perhaps a line of names first.
/// Errors: those of read_input_text; InputError naming the file, its line and the remedy.
std::vector<bool> occupied_hours(const std::vector<SkyHour>& hours, const Occupancy& occupancy);

/// The half of all hours with the most diffuse light, the daylight hours of EN 17037: 4,380.
std::vector<bool> daylight_hours(const std::vector<SkyHour>& hours);

/// Diffuse lux outdoors that half of the daylight hours reach: EN 17037 has it for capitals.
double median_outdoors(const std::vector<SkyHour>& hours);

/// The daylight of one sensor. Fractions are of the occupied hours.
struct PointDaylight {
  double mean_lux = 0;             ///< over the whole year
  double autonomy = 0;             ///< DA: share with the requested lux or more
  double continuous_autonomy = 0;  ///< cDA: hours with less count as lux over requested lux
  std::array<double, 4> useful{};  ///< UDI: below 100, to 300, to 3000, above (lux)
  double sun_hours = 0;   ///< occupied hours with more than 1,000 lux straight from the sun
  double median_lux = 0;  ///< that half of the daylight hours reach
};

PointDaylight point_daylight(std::span<const float> lux, std::span<const float> sun,
                             const std::vector<bool>& occupied, const std::vector<bool>& daylight,
                             double target_lux);

/// The daylight of all sensors of a room.
struct RoomDaylight {
  double mean_lux = 0;
  double autonomy = 0;             ///< mean of the points'
  double spatial_autonomy = 0;     ///< sDA: share of points with DA of half or more (IES LM-83)
  double sunlight_exposure = 0;    ///< ASE: share with more than 250 h of sun above 1,000 lux
  std::array<double, 4> useful{};  ///< means of the points'
  double target_lux = 0;           ///< EN 17037: that half of the points reach, of their medians
  double minimum_target_lux = 0;   ///< that 95% reach
  std::string level;               ///< "high", "medium", "minimum" or "none", of EN 17037
};
RoomDaylight room_daylight(std::span<const PointDaylight> points);

/// The standard error of a figure that was made of independent parts, by what it is without each of
/// them (the delete-m jackknife of Busing, Meijer and van der Leeden, 1999); 0 of a single part.
///   shares   of the parts in all
double jackknife_error(double all, std::span<const double> without, std::span<const double> shares);

/// Standard errors of a room's figures, and of the DA of its points.
struct DaylightErrors {
  double mean_lux = 0, autonomy = 0, spatial_autonomy = 0;
  std::array<double, 4> useful{};
  std::vector<double> point_autonomy;
};

/// That of sDA counts points whose DA may lie on the other side of a half, each by the probability
/// that its own error gives, and that errors of points go together as far as they do in the parts.
///   without   the points without each of the parts
DaylightErrors daylight_errors(std::span<const PointDaylight> points,
                               std::span<const std::vector<PointDaylight>> without,
                               std::span<const double> shares);

/// Lamps that add what daylight lacks.
struct LampEnergy {
  std::string lamp;
  double watts = 0;           ///< at full power
  double kilowatt_hours = 0;  ///< of the year's occupied hours, dimmed
  double undimmed = 0;        ///< the same at full power
};

/// All lamps together are dimmed, each hour, so that the mean over the room's sensors is the
/// requested lux, or are at full power where that is not enough.
///   lamp_mean   lux of each lamp, the mean over the sensors
///   watts       of each lamp
std::vector<LampEnergy> lamp_energy(std::span<const double> mean_daylight,
                                    const std::vector<bool>& occupied,
                                    const std::vector<std::string>& light_sampler,
                                    std::span<const double> lamp_mean,
                                    std::span<const double> watts, double target_lux);

}  // namespace photile::daylight
