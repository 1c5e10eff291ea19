// Material libraries of an OBJ file.
#pragma once

#include <tiny_obj_loader.h>

#include <string>
#include <vector>

#include "reading/import_context.hpp"

namespace photile::obj {

/// The materials of the libraries that mtllib statements name, from the scene's folder, in their
/// order. A statement may name several files. Names with blanks are written with backslashes before
/// them or, by most exporters, without: the file that the whole statement names comes first.
///   statements   what follows each `mtllib`
/// Libraries that cannot be read are named in a warning.
std::vector<tinyobj::material_t> read_obj_libraries(const std::vector<std::string>& statements,
                                                    reading::ImportContext& context);

}  // namespace photile::obj
