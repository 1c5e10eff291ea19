// Decoders of compressed meshes, in a separate module: files without compressed meshes need neither
// library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace photile::gltf {

/// How a buffer view of EXT_meshopt_compression is packed.
enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential };

struct MeshoptView {
  MeshoptMode mode;
  MeshoptFilter filter;
  std::size_t count, stride;  ///< of the elements, bytes
  std::span<const unsigned char> packed;
};

/// An attribute of a mesh of KHR_draco_mesh_compression.
struct DracoAttribute {
  std::uint32_t id;                        ///< of Draco's
  int component_type;                      ///< asked for, a constant of glTF's (GL_FLOAT, ...)
  int components;                          ///< asked for
  std::vector<unsigned char> values = {};  ///< of each point, without gaps
};

struct DracoMesh {
  std::size_t points = 0;
  std::vector<std::uint32_t> corners;  ///< three points a triangle
};

}  // namespace photile::gltf

extern "C" {
/// Fills count * stride bytes. Returns whether the packed ones were sound.
bool photile_unpack_meshopt(const photile::gltf::MeshoptView& view, unsigned char* unpacked);

/// Decodes a triangle mesh and the attributes that are asked for. Returns "", or what is wrong.
///   most   bytes that it may take: those that it says it has are counted before they are unpacked
const char* photile_unpack_draco(std::span<const unsigned char> packed, std::uint64_t most,
                                 std::vector<photile::gltf::DracoAttribute>& attributes,
                                 photile::gltf::DracoMesh& mesh);
}
