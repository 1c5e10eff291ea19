// Wavefront OBJ + MTL to a scene. OBJ has no units: metres and watts are assumed.
#pragma once

#include "import/import_context.hpp"

namespace photile::scene_io {

/// Fills the context's scene from its OBJ file. Errors: InputError.
void import_obj(ImportContext& context);

}  // namespace photile::scene_io
