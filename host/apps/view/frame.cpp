#include "view/frame.hpp"

namespace photile::view {

void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix, const image::White& white) {
  const auto picture = mixed_picture(frame.layers, mix);
  set_camera_attributes(picture->header(), in_world(scene, frame.camera), frame.layers.width,
                        frame.layers.height);
  image::keep_white(picture->header(), white);
  write_exr(file, *picture);
}

std::vector<glm::vec3> scales_of(const LightMix& mix) {
  std::vector<glm::vec3> scales;
  for (const MixedLight& light : mix.lights) {
    scales.emplace_back(mix.power_in_picture(light) * glm::dvec3(light.tint));
  }
  return scales;
}

}  // namespace photile::view
