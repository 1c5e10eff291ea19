// Where in its file a light comes from.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>

#include "photile/scene.hpp"

namespace photile::reading {

struct LightSource {
  enum class Kind : std::uint8_t {
    node,         ///< KHR_lights_punctual or photometric data at a glTF node
    surface,      ///< an emissive material
    panel,        ///< a luminous rectangle or disc at a glTF node
    picture,      ///< EXT_lights_image_based of the glTF scene
    surroundings  ///< an option, not the file
  };
  Kind kind = Kind::surroundings;
  std::uint32_t node = none;      ///< of the glTF file
  std::uint32_t material = none;  ///< of a surface: into Scene::materials, and the glTF file's
  std::string lamp = {};          ///< what the file has once for all instances; "" = just this one

  /// What instances of one lamp have in common, and no other lights.
  using LampKey = std::tuple<Kind, std::uint32_t, std::string>;
  LampKey lamp_key() const { return {kind, material, lamp}; }
};

/// What a file says of the lights of an object beside their emission.
struct LightTraits {
  std::string group;      ///< "" = none
  double lumens = 0;      ///< of the object's lights together; 0 = not given
  double kelvin = 0;      ///< 0 = not given
  std::string lamp = {};  ///< as LightSource::lamp
};

}  // namespace photile::reading
