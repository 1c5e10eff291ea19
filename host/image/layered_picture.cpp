#include "photile/layered_picture.hpp"

#include <utility>

namespace photile {

std::vector<std::string> LayeredPicture::channel_names(std::size_t light) const {
  const Layer& layer = layers_[light];
  std::vector<std::string> names;
  for (const char* component : {".R", ".G", ".B"}) {
    names.push_back("Combined_" + layer.light + component);
  }
  if (layer.illuminance) names.push_back("Illuminance_" + layer.light + ".Y");
  return names;
}

Image to_image(const LayeredPicture& picture) {
  Image image = picture.root();
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    LightRows rows = picture.read(light, 0, image.height);
    std::vector<std::vector<float>> planes;
    for (std::vector<float>& plane : rows.rgb) planes.push_back(std::move(plane));
    planes.push_back(std::move(rows.illuminance));
    const std::vector<std::string> names = picture.channel_names(light);
    for (std::size_t i = 0; i < names.size(); ++i) image.add(names[i]) = std::move(planes[i]);
  }
  return image;
}

}  // namespace photile
