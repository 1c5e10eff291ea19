#include "photile/light_layers.hpp"

namespace photile {

LightLayers::LightLayers(int width, int height, const std::vector<Light>& lights)
    : width(width), height(height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  layers.reserve(lights.size());
  for (const Light& light : lights) {
    layers.push_back(
        {light.name, std::vector<glm::vec3>(pixels, glm::vec3(0.0f)), std::vector<float>(pixels)});
  }
}

}  // namespace photile
