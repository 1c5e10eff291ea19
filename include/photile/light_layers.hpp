// One layer per light: the picture before the lights are mixed.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/scene.hpp"

namespace photile {

/// One layer of the picture: a light, or all lights of a group at their powers. Its power scales
/// them together.
struct LightGroup {
  std::string name;                   ///< of the group, or of the light alone
  std::vector<std::uint32_t> lights;  ///< into Scene::lights, ascending
  double power = 0;                   ///< sum of the lights' powers, in Scene::unit
  glm::vec3 color{0.0f};              ///< of their light together; luminance 1
};

/// The layers of a scene and what each light contributes to its layer.
struct LightGroups {
  std::vector<LightGroup> groups;       ///< in the order of their first lights
  std::vector<std::uint32_t> group_of;  ///< per light
  /// Per light: its part of its group's power; exactly 1 for a light alone. Lights of a group that
  /// is off share equally.
  std::vector<double> fraction;
};

/// Lights with the same non-empty Light::group share a layer; every other light has its own.
LightGroups light_groups_of(const Scene& scene);

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
  /// The layers of a scene, in the order of LightGroups::groups.
  LightLayers(int width, int height, const Scene& scene);

  bool sparse() const { return !rows.empty(); }
  std::uint64_t bytes() const;
  /// The layers with a plane per light: 16 bytes per pixel and light.
  LightLayers dense() const;
};

/// A mixdown of the lights' layers: each is multiplied by a number and added to another. Hundreds
/// of patches of a sky become one layer, which costs a film as much as one light.
struct LayerMixdown {
  std::vector<std::string> layers;      ///< of the film
  std::vector<std::uint32_t> layer_of;  ///< per layer of the scene: into `layers`
  std::vector<float> scale;             ///< per layer of the scene
};

}  // namespace photile
