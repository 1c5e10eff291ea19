#include "view/frame.hpp"

namespace photile::view {

std::vector<glm::vec3> scales_of(const LightMix& mix) {
  std::vector<glm::vec3> scales;
  for (const MixedLight& light : mix.lights) {
    scales.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
  }
  return scales;
}

}  // namespace photile::view
