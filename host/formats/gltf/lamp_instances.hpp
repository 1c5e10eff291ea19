// Lights that a file has once and places several times: the downlights of a ceiling.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gltf/tiny_gltf.hpp"
#include "photile/scene.hpp"
#include "reading/light_source.hpp"

namespace photile::gltf {

/// LightSource::lamp of the light that an extension of a node refers to; "" where it has none.
std::string lamp_of(const tinygltf::Node& node, const std::string& extension);

/// Makes a group of those lights without one whose lamp is the same, named after the first of them,
/// so that they share a layer.
///   sources   of the lights
void group_instances(std::vector<Light>& lights, std::span<const reading::LightSource> sources);

}  // namespace photile::gltf
