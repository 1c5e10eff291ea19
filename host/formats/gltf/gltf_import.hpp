#pragma once

#include "reading/import_context.hpp"

namespace photile::gltf {

/// Fills the context's scene from its .gltf or .glb file. Errors: InputError.
void import_gltf(reading::ImportContext& context);

}  // namespace photile::gltf
