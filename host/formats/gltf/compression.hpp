// Compressed meshes of glTF: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include <string>
#include <string_view>

#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// The JSON of a file with compressed meshes without what a reader stumbles over that does not know
/// them: buffers that stand for what meshopt has packed, and have no bytes, and indices that only
/// Draco's data has. "" where nothing has to be changed.
std::string without_packed_parts(std::string_view json);

/// Unpacks what is compressed into buffers of its own, so that the model is read as any other.
/// Errors: InputError that names a view or mesh which is damaged; UsageError where photile was
/// built without the decoders.
void unpack_meshes(tinygltf::Model& model, const reading::ImportContext& context);

}  // namespace photile::gltf
