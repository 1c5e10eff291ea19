// Which glTF extensions are understood, and what is lost without the others.
#pragma once

#include "import/gltf/tiny_gltf.hpp"
#include "import/import_context.hpp"

namespace photile::scene_io {

/// Names every extension that the file uses and photile does not understand in a warning. Errors:
/// InputError naming one that the file requires, with the remedy.
void check_extensions(const tinygltf::Model& model, ImportContext& context);

/// The same for a file that could not be parsed, often because of what an extension left out of it
/// (buffers without data, ...). Does nothing where its JSON names no such extension.
void check_required_extensions(std::string_view json, const ImportContext& context);

}  // namespace photile::scene_io
