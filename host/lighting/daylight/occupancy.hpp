// The hours in which a room is used.
#pragma once

#include <array>
#include <filesystem>
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

/// Of a schedule's file those are occupied whose value is more than 0: a line for each hour of the
/// year, whose last field is the value, and perhaps a line of names first.
/// Errors: those of read_input_text; InputError naming the file, its line and the remedy.
std::vector<bool> occupied_hours(const std::vector<SkyHour>& hours, const Occupancy& occupancy);

}  // namespace photile::daylight
