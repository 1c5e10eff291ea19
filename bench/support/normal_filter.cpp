#include <cmath>

#include "support/host_search.hpp"

namespace photile::bench {

NormalFilter::NormalFilter(const Scene& scene, double angle_degrees)
    // The slack of normals_agree, in single precision.
    : least_cosine_(static_cast<float>(std::cos(glm::radians(angle_degrees)) - 1e-6)) {
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    normals_.emplace_back(sided_normal(scene, s));
  }
}

}  // namespace photile::bench
