// The triangles of glTF primitives, as the file has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/materials.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"
#include "reading/triangles.hpp"
#include "scene/mesh_builder.hpp"

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

// Vertices of a glTF primitive where its node places them.

/// As the file has them, one after another: 3 floats a vertex, of tangents 4, of coordinates 2. All
/// but the positions are empty where they are absent or not wanted.
struct VertexAttributes {
  std::vector<float> positions, normals, tangents, uv, emission_uv;
};

/// Each vertex is placed when a triangle asks for it: all of them at once would take several times
/// the memory of the file, which takes longer to get than to fill.
class PlacedVertices {
 public:
  /// `coordinates` is kept.
  PlacedVertices(VertexAttributes attributes, const MaterialCoordinates& coordinates,
                 const glm::dmat4& world);

  std::size_t size() const { return attributes_.positions.size() / 3; }
  scene::Corner operator[](std::uint32_t vertex) const;

 private:
  VertexAttributes attributes_;
  const MaterialCoordinates& coordinates_;
  glm::dmat4 world_;
  glm::dmat3 normal_matrix_;
};

// Triangles of glTF meshes.

/// Adds the triangles of every visited node's mesh to the scene. Morph targets and skins stay in
/// their rest pose; points and lines are left out; both with a warning. Errors: InputError.
void add_gltf_meshes(const tinygltf::Model& model, const AccessorReader& accessors,
                     const std::vector<NodeVisit>& visits,
                     const std::vector<MaterialCoordinates>& coordinates,
                     reading::ImportContext& context);

}  // namespace photile::gltf
