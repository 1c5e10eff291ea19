// glTF 2.0 to a scene.
#pragma once

#include "import/import_context.hpp"

namespace photile::scene_io {

/// Fills the context's scene from its .gltf or .glb file. Errors: InputError.
void import_gltf(ImportContext& context);

}  // namespace photile::scene_io
