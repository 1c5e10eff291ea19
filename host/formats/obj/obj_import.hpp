#pragma once

#include "reading/import_context.hpp"

namespace photile::obj {

/// Fills the context's scene from its OBJ file. Errors: InputError.
void import_obj(reading::ImportContext& context);

}  // namespace photile::obj
