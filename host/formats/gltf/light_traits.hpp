// What a node of a glTF file says about its lights, whatever their kind.
#pragma once

#include <string>

#include "gltf/tiny_gltf.hpp"
#include "files/warnings.hpp"
#include "reading/light_source.hpp"

namespace photile::scene_io {

/// The traits of the node `name` by the extras `photile_group`, `photile_lumens` and `photile_kelvin`,
/// which Blender exports as custom properties. Numbers that are none, or out of range, are ignored with a warning.
LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                         Warnings& warnings);

}  // namespace photile::scene_io
