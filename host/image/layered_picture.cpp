#include "image/layered_picture.hpp"

#include <utility>

namespace photile::image {

void set_layered_channels(Image& image, const std::vector<std::string>& lights,
                          std::vector<LightPlanes> planes, std::vector<float> alpha) {
  constexpr std::array<const char*, 3> components{"R", "G", "B"};
  for (std::size_t component = 0; component < 3; ++component) {
    std::vector<float>& sum = image.add(components[component]);
    for (const LightPlanes& light : planes) {
      const std::vector<float>& plane = light.rgb[component];
      for (std::size_t pixel = 0; pixel < sum.size(); ++pixel) sum[pixel] += plane[pixel];
    }
  }
  image.add("A") = std::move(alpha);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t component = 0; component < 3; ++component) {
      image.add("Combined_" + lights[i] + "." + components[component]) =
          std::move(planes[i].rgb[component]);
    }
    if (planes[i].illuminance.empty()) continue;
    image.add("Illuminance_" + lights[i] + ".Y") = std::move(planes[i].illuminance);
  }
}

}  // namespace photile::image
