#include "support/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace photile::bench {
namespace {

/// Also true where either is not a number.
bool differs(double a, double b, double scale, double relative) {
  return !(std::abs(a - b) <= relative * scale);
}

}  // namespace

std::vector<std::size_t> irradiance_differences(std::span<const glm::vec3> irradiance,
                                                std::span<const glm::vec3> reference,
                                                double relative) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const glm::vec3 r = reference[i];
    const double scale = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
    bool different = false;
    for (int c = 0; c < 3; ++c) different |= differs(irradiance[i][c], r[c], scale, relative);
    if (different) found.push_back(i);
  }
  return found;
}

bool has_tied_rim(const Photons& photons, const NormalFilter& filter, const glm::vec3& position,
                  std::uint32_t sided_triangle, float squared_radius) {
  constexpr double rounding = 1e-6;
  int on_rim = 0;
  for (std::size_t p = 0; p < photons.size(); ++p) {
    const glm::dvec3 d = glm::dvec3(photons.position[p]) - glm::dvec3(position);
    if (std::abs(glm::dot(d, d) - squared_radius) > rounding * squared_radius) continue;
    on_rim += filter.agree(photons.sided_triangle[p], sided_triangle) ? 1 : 0;
  }
  return on_rim > 1;
}

std::uint64_t count_radius_differences(std::span<const float> squared_radius,
                                       std::span<const float> reference, double relative) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    count += differs(squared_radius[i], reference[i], reference[i], relative) ? 1 : 0;
  }
  return count;
}

}  // namespace photile::bench
