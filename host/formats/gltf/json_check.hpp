// The JSON of a glTF file, looked through before anything is made of it.
#pragma once

#include <string_view>

#include "reading/import_context.hpp"

namespace photile::gltf {

/// Reads the text once, as a stream: whatever it says, that takes no memory but for its depth.
/// tinygltf would build all of it, recursively, and read numbers that are out of their range as
/// others. Errors: InputError where it is no JSON, is nested deeper than limits::max_json_depth,
/// has more nodes or materials than the limits, or where a number, count or offset of the format is
/// no whole number of its range.
void check_json(std::string_view json, const reading::ImportContext& context);

}  // namespace photile::gltf
