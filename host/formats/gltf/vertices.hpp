// Vertices of a glTF primitive where its node places them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gltf/materials.hpp"
#include "scene/mesh_builder.hpp"

namespace photile::gltf {

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

}  // namespace photile::gltf
