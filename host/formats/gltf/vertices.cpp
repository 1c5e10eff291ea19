#include "gltf/vertices.hpp"

#include <utility>

namespace photile::gltf {
namespace {

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

glm::dvec2 mapped(const std::vector<float>& uv, std::size_t vertex, const TextureCoordinates& map) {
  return uv.empty() ? glm::dvec2(0.0) : map(glm::dvec2(uv[2 * vertex], uv[2 * vertex + 1]));
}

/// The cofactor matrix is the inverse transpose times the determinant: it needs no division, and
/// only the direction of a normal counts. MeshBuilder mends the sign of mirrored ones.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

PlacedVertices::PlacedVertices(VertexAttributes attributes, const MaterialCoordinates& coordinates,
                               const glm::dmat4& world)
    : attributes_(std::move(attributes)),
      coordinates_(coordinates),
      world_(world),
      normal_matrix_(cofactors(glm::dmat3(world))) {}

scene::Corner PlacedVertices::operator[](std::uint32_t vertex) const {
  const std::size_t i = vertex;
  const auto& [positions, normals, tangents, uv, emission_uv] = attributes_;
  scene::Corner corner;
  corner.position = glm::dvec3(world_ * glm::dvec4(vector_at(positions, 3 * i), 1.0));
  corner.uv = mapped(uv, i, coordinates_.surface);
  corner.emission_uv = mapped(emission_uv, i, coordinates_.emission);
  if (!normals.empty()) corner.normal = normal_matrix_ * vector_at(normals, 3 * i);
  if (tangents.empty()) return corner;
  corner.tangent = glm::dmat3(world_) * vector_at(tangents, 4 * i);
  // Of a mirrored node the cofactors turn the normal round, and with it the bitangent.
  corner.handedness = double{tangents[4 * i + 3]};
  return corner;
}

}  // namespace photile::gltf
