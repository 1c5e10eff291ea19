// Values between keyframes.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

namespace photile::scene {

/// Keyframes `index` and index + 1 around a time, and how far it lies between them.
struct Between {
  std::size_t index;
  double share;  ///< in [0, 1]
};

/// Of ascending times; before the first and after the last it stays there. One time: share 0 of it.
Between between(std::span<const double> times, double time);

/// Cubic Hermite curve: from value a with tangent at_a, per unit of share, to b.
template <class T>
T hermite(const T& a, const T& at_a, const T& b, const T& at_b, double share) {
  const double s = share, s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a + (s3 - 2 * s2 + s) * at_a + (3 * s2 - 2 * s3) * b +
         (s3 - s2) * at_b;
}

/// A smooth curve through points at ascending times: see read_camera_path.
glm::dvec3 smooth(std::span<const double> times, std::span<const glm::dvec3> values, double time);

/// Straight lines between them.
glm::dvec3 linear(std::span<const double> times, std::span<const glm::dvec3> values, double time);

}  // namespace photile::scene
