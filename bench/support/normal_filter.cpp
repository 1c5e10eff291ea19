#include <algorithm>
#include <cmath>
#include <utility>

#include "maps/build_maps.hpp"
#include "support/host_search.hpp"

namespace photile::bench {

NormalFilter::NormalFilter(const Scene& scene, double angle_degrees)
    : NormalFilter(maps::face_normals(scene), angle_degrees) {}

NormalFilter::NormalFilter(std::vector<glm::vec3> normals, double angle_degrees)
    : normals_(std::move(normals)),
      // The slack of normals_agree, in single precision.
      least_cosine_(static_cast<float>(std::cos(glm::radians(angle_degrees)) - 1e-6)) {}

bool NormalFilter::all_agree(std::span<const std::uint32_t> photons,
                             std::span<const std::uint32_t> hits) const {
  if (photons.empty()) return true;
  const glm::vec3& normal = normals_[photons[0]];
  const auto is_same = [&](std::uint32_t face) {
    return photons[0] == face || glm::dot(normals_[face], normal) > 1.0f - 1e-6f;
  };
  return std::all_of(photons.begin(), photons.end(), is_same) &&
         std::all_of(hits.begin(), hits.end(), is_same);
}

}  // namespace photile::bench
