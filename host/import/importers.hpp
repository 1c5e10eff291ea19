// Scene files to a scene, by their format.
#pragma once

#include "import/import_context.hpp"

namespace photile::scene_io {

/// Fills the context's scene from its .gltf or .glb file. Errors: InputError.
void import_gltf(ImportContext& context);

/// Fills the context's scene from its OBJ file. Errors: InputError.
void import_obj(ImportContext& context);

}  // namespace photile::scene_io
