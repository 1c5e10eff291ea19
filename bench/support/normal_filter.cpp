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

}  // namespace photile::bench
