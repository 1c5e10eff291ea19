// Cameras of a glTF file.
#pragma once

#include <vector>

#include "import/gltf/nodes.hpp"
#include "import/gltf/tiny_gltf.hpp"
#include "import/import_context.hpp"

namespace photile::scene_io {

/// Adds the perspective cameras of all visited nodes: they look along -z of their node, y upwards.
/// Orthographic ones and those without a sensible field of view are skipped with a warning.
void add_gltf_cameras(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                      ImportContext& context);

}  // namespace photile::scene_io
