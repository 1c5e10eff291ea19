// KHR_lights_punctual and EXT_lights_ies.
#pragma once

#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Adds the lights without size of all visited nodes. Directional lights get their irradiance as
/// `power`; load_scene turns it into flux. Black lights are dropped with a warning, `range` (an
/// unphysical cutoff) is ignored with one. The group is that of the node, or else of the light.
/// Photometric data at a node (profiles.hpp) makes a point light; light_traits.hpp says what
/// else a node's extras tell. Errors: InputError.
void add_gltf_lights(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits, reading::ImportContext& context);

}  // namespace photile::gltf
