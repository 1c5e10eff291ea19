// The box that a set of triangles fills, along the axis that their normals share.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/scene.hpp"

namespace photile::groups {

/// The data of each triangle for clustering, computed once.
struct TriangleFacts {
  std::vector<glm::vec3> normal;  ///< unit, of side 0
  std::vector<float> area;        ///< square metres

  explicit TriangleFacts(const Scene& scene);
};

/// An oriented box around triangles. Heights are measured along `axis`, the direction closest to
/// all normals, whichever way the triangles are wound.
struct PatchShape {
  glm::dvec3 axis{0, 0, 1}, u_axis{1, 0, 0}, v_axis{0, 1, 0};  ///< orthonormal
  glm::dvec3 low{0}, high{0};  ///< coordinates along u_axis, v_axis, axis, metres
  double area = 0;             ///< of the triangles, one side, square metres
  double least_cosine = 1;     ///< of the angle between a normal and the axis, without sign

  const glm::dvec3& direction(int i) const { return i == 0 ? u_axis : i == 1 ? v_axis : axis; }
  double width(int i) const { return high[i] - low[i]; }
  double thickness() const { return width(2); }
  double diagonal() const { return glm::length(high - low); }
  /// Area of the box's rectangle grown by `radius` on all sides: where photons of the map may lie.
  double grown_area(double radius) const {
    return (width(0) + 2 * radius) * (width(1) + 2 * radius);
  }
};

PatchShape shape_of(const Scene& scene, const TriangleFacts& facts,
                    std::span<const std::uint32_t> triangles);

/// The part of the shape's rectangle that its triangles cover, on a raster of cells of at least
/// `cell_size` metres: 0 to 1.
double covered_part(const Scene& scene, const PatchShape& shape,
                    std::span<const std::uint32_t> triangles, double cell_size);

/// Corners of a triangle along the axes of a shape.
inline std::array<glm::dvec3, 3> local_corners(const Scene& scene, const PatchShape& shape,
                                               std::uint32_t triangle) {
  std::array<glm::dvec3, 3> local;
  const auto corners = scene.corners(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 p(corners[i]);
    local[i] = {glm::dot(p, shape.u_axis), glm::dot(p, shape.v_axis), glm::dot(p, shape.axis)};
  }
  return local;
}

}  // namespace photile::groups
