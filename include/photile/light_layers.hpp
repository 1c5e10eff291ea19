// One layer per light: the picture before the lights are mixed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/light_groups.hpp"

namespace photile {

/// Radiance and illuminance per pixel and light, each light at power 1; a group of lights is one.
/// With up to max_dense_lights lights a plane for each; with more, per pixel the lights that reach
/// it.
struct LightLayers {
  int width = 0, height = 0;
  struct Layer {
    std::string light;
    std::vector<glm::vec3> radiance;  ///< linear RGB, cd/m2 per lm or W/(m2 sr) per W
    std::vector<float> illuminance;   ///< of the surface seen: lux per lm or W/m2 per W, luminance
  };
  std::vector<Layer> layers;  ///< planes are empty in sparse layers

  /// A row of sparse layers. Pixel x has the values [first[x], first[x + 1]).
  struct Row {
    std::vector<std::uint32_t> first;  ///< width + 1
    std::vector<std::uint16_t> light;  ///< index into `layers`, ascending within a pixel
    std::vector<glm::vec3> radiance;   ///< as in Layer
    std::vector<float> illuminance;    ///< as in Layer
  };
  std::vector<Row> rows;  ///< of sparse layers, one per row of the picture; else empty

  LightLayers() = default;
  /// Black layers in the order of the names, sparse where they are many.
  LightLayers(int width, int height, const std::vector<std::string>& names);
  /// Those of a scene, in the order of LightGroups::groups.
  LightLayers(int width, int height, const Scene& scene);

  bool sparse() const { return !rows.empty(); }
  std::uint64_t bytes() const;
  /// The same with a plane per light: 16 bytes per pixel and light.
  LightLayers dense() const;
};

}  // namespace photile
