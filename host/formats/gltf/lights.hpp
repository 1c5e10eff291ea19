// The lights without size of a glTF file (KHR_lights_punctual, EXT_lights_ies), and the extras of a
// node about any light.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "files/scene_files.hpp"
#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"
#include "reading/import_context.hpp"

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

/// Whether a node's extras define a light.
bool has_profile(const tinygltf::Node& node);

/// Adds the lights without size of all visited nodes. Directional lights get their irradiance as
/// `power`; load_scene turns it into flux. Black lights are dropped with a warning, `range` (an
/// unphysical cutoff) is ignored with one. The group is that of the node, or else of the light.
/// Photometric data at a node (EXT_lights_ies, or `photile_ies` among its extras) makes a point
/// light. Errors: InputError.
void add_gltf_lights(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits, reading::ImportContext& context);

}  // namespace photile::gltf
