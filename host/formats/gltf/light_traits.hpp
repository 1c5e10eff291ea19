// What a node of a glTF file says about its lights, whatever their kind.
#pragma once

#include <string>

#include "files/warnings.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/light_source.hpp"

namespace photile::gltf {

/// The traits of the node `name` by the extras `photile_group`, `photile_lumens` and
/// `photile_kelvin`, which Blender exports as custom properties. Numbers that are none, or out of
/// range, are ignored with a warning.
reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings);

}  // namespace photile::gltf
