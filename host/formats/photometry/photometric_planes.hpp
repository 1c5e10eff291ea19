// Half-planes of measurement about a lamp's axis, and what a symmetric lamp leaves out of them.
#pragma once

#include <cstddef>
#include <vector>

namespace photile::photometry {

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
