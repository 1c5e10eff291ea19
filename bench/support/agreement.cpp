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

std::uint64_t count_irradiance_differences(std::span<const glm::vec3> irradiance,
                                           std::span<const glm::vec3> reference, double relative) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const glm::vec3 r = reference[i];
    const double scale = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
    bool different = false;
    for (int c = 0; c < 3; ++c) different |= differs(irradiance[i][c], r[c], scale, relative);
    count += different ? 1 : 0;
  }
  return count;
}

std::uint64_t count_radius_differences(std::span<const float> squared_radius,
                                       std::span<const float> reference, double relative) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    count += differs(squared_radius[i], reference[i], reference[i], relative) ? 1 : 0;
  }
  return count;
}

HitSample sample_of(const PrimaryHits& hits, std::size_t wanted) {
  HitSample sample;
  const std::size_t step = std::max<std::size_t>(1, hits.size() / wanted);
  for (std::size_t i = 0; i < hits.size(); i += step) {
    sample.index.push_back(static_cast<std::uint32_t>(i));
    sample.hits.position.push_back(hits.position[i]);
    sample.hits.sided_triangle.push_back(hits.sided_triangle[i]);
    sample.hits.pixel.push_back(hits.pixel[i]);
    sample.hits.throughput.push_back(hits.throughput[i]);
    sample.hits.diffuse_albedo.push_back(hits.diffuse_albedo[i]);
  }
  return sample;
}

}  // namespace photile::bench
