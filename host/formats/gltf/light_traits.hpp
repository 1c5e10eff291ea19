// What a node of a glTF file says about its lights, whatever their kind.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "files/warnings.hpp"
#include "gltf/tiny_gltf.hpp"
#include "photile/scene.hpp"
#include "reading/light_source.hpp"

namespace photile::gltf {

/// The traits of the node `name` by the extras `photile_group`, `photile_lumens` and
/// `photile_kelvin`, which Blender exports as custom properties. Numbers that are none, or out of
/// range, are ignored with a warning.
reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings);

/// LightSource::lamp of the light that an extension of a node refers to; "" where it has none.
std::string lamp_of(const tinygltf::Node& node, const std::string& extension);

/// Makes a group of those lights without one whose lamp is the same, named after the first of them,
/// so that they share a layer.
///   sources   of the lights
void group_instances(std::vector<Light>& lights, std::span<const reading::LightSource> sources);

}  // namespace photile::gltf
