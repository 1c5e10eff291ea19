// KHR_lights_punctual.
#pragma once

#include <vector>

#include "scene/gltf_nodes.hpp"
#include "scene/import_context.hpp"
#include "scene/tiny_gltf.hpp"

namespace photile::scene_io {

/// Adds the punctual lights of all visited nodes. Directional lights get their irradiance as
/// `power`; load_scene turns it into flux. Black lights are dropped with a warning, `range` (an
/// unphysical cutoff) is ignored with one. The group is that of the node, or else of the light.
/// Errors: InputError.
void add_gltf_lights(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                     ImportContext& context);

}  // namespace photile::scene_io
