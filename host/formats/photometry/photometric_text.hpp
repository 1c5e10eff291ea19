// Numbers in the text of photometric files, whatever the locale says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/ascii_text.hpp"

namespace photile::photometry {

/// Reads numbers separated by blanks, commas or ends of lines.
class NumberReader {
 public:
  /// `lines` must outlive this; reading starts at line `first`, counted from 0.
  NumberReader(const std::vector<std::string_view>& lines, std::size_t first)
      : lines_(lines), line_(first) {}

  /// Errors: ResourceError that tells `what` is missing, or no number, and in which line.
  double number(const std::string& what);
  /// A whole number in [lowest, highest]. Errors: ResourceError.
  std::size_t count(const std::string& what, std::uint64_t lowest, std::uint64_t highest);
  std::vector<double> numbers(const std::string& what, std::size_t count);

  /// For messages: "line 12".
  std::string place() const;

 private:
  std::string_view token();

  const std::vector<std::string_view>& lines_;
  std::size_t line_;
  std::size_t column_ = 0;
};

/// Degrees between the angles of a file: mirrored, or turned by right angles, they still differ.
inline constexpr double least_angle_step = 1e-6;

/// A half-plane of intensities: its azimuth, and which of the measured ones it repeats.
struct MeasuredPlane {
  double azimuth;  ///< degrees
  std::size_t measured;
};

/// The planes all around a lamp, ascending, from the azimuths that were measured: one (rotational
/// symmetry), 0 to 90 (symmetric to two planes), 0 to 180 or 90 to 270 (to one), or 360 degrees,
/// of which the last may be missing. Azimuths ascend. Errors: ResourceError for any other range.
std::vector<MeasuredPlane> planes_all_around(const std::vector<double>& azimuths);

}  // namespace photile::photometry
