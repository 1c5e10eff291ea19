// The triangles of glTF primitives, as the file has them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"
#include "reading/instance_recorder.hpp"

namespace photile::gltf {

/// Whether a primitive's mode makes triangles.
bool has_triangles(int mode);

/// Whether triangles can be made of it: of its mode, and positions that are not all 0, as those of
/// meshes that an extension compresses are. Errors: InputError for a wrong accessor number, naming
/// `use`.
bool is_usable(const tinygltf::Primitive& primitive, const std::string& use,
               const AccessorReader& accessors);

/// The accessor of an attribute, or -1.
int attribute(const tinygltf::Primitive& primitive, const std::string& name);

/// Corner numbers of the triangles that a primitive's mode makes of its index list.
std::vector<std::array<std::uint32_t, 3>> assemble(const std::vector<std::uint32_t>& indices,
                                                   int mode);

/// The index list of a primitive of so many corners; 0, 1, 2 ... where it has none. `use` names the
/// mesh in errors. Errors: InputError for an index beyond the corners.
std::vector<std::uint32_t> read_indices(const tinygltf::Primitive& primitive,
                                        std::size_t corner_count, const std::string& use,
                                        const AccessorReader& accessors,
                                        const reading::ImportContext& context);

/// What messages call a mesh.
std::string name_of_mesh(const tinygltf::Model& model, int mesh);

/// All usable primitives of a mesh, in its own space. Errors: InputError.
reading::LocalMesh read_local_mesh(const tinygltf::Model& model, int mesh,
                                   const AccessorReader& accessors,
                                   const reading::ImportContext& context);

}  // namespace photile::gltf
