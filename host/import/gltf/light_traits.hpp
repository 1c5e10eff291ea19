// What a node of a glTF file says about its lights, whatever their kind.
#pragma once

#include <string>

#include "import/gltf/tiny_gltf.hpp"
#include "import/warnings.hpp"

namespace photile::scene_io {

/// Of the extras `photile_group`, `photile_lumens` and `photile_kelvin`, which Blender exports as
/// custom properties.
struct LightTraits {
  std::string group;      ///< "" = none
  double lumens = 0;      ///< of the node's lights together; 0 = not given
  double kelvin = 0;      ///< 0 = not given
  std::string lamp = {};  ///< as LightSource::lamp
};

/// Traits of the node `name`. Numbers that are none, or out of range, are ignored with a warning.
LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                         Warnings& warnings);

}  // namespace photile::scene_io
