// One layer per light: the picture before the lights are mixed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile {

/// Radiance and illuminance per pixel and light, each light at power 1.
struct LightLayers {
  int width = 0, height = 0;
  struct Layer {
    std::string light;
    std::vector<glm::vec3> radiance;  ///< linear RGB, cd/m2 per lm or W/(m2 sr) per W
    std::vector<float> illuminance;   ///< of the surface seen: lux per lm or W/m2 per W, luminance
  };
  std::vector<Layer> layers;  ///< in the order of Scene::lights

  LightLayers() = default;
  LightLayers(int width, int height, const std::vector<Light>& lights);
};

}  // namespace photile
