// Surface in cells of a grid, in which the photons of a pilot measure how light is spread.
#pragma once

#include <tsl/robin_set.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "common/content_hash.hpp"
#include "photile/scene.hpp"

namespace photile::trace {

/// Cubes of a grid around the middle of a scene.
class SurfaceCells {
 public:
  /// The surface in a cube that faces one way along an axis.
  using Facing = std::array<std::int32_t, 4>;

  /// Cubes as wide as the scene's radius, halved until those surfaces that hold any of `count`
  /// elements hold at most `per_cell` on average.
  ///   cell_of   (cells, i): the surface of element i
  template <class CellOf>
  SurfaceCells(const BoundingSphere& bounds, std::size_t count, double per_cell,
               const CellOf& cell_of)
      : centre_(bounds.center), per_metre_(1 / bounds.radius) {
    for (int halvings = 0; halvings < most_halvings; ++halvings, per_metre_ *= 2) {
      tsl::robin_set<Facing, BytesHash> cells;
      for (std::size_t i = 0; i < count; ++i) cells.insert(cell_of(*this, i));
      if (static_cast<double>(count) <= per_cell * static_cast<double>(cells.size())) return;
    }
  }

  ///   normal   geometric
  Facing of(const glm::vec3& position, const glm::vec3& normal) const {
    const glm::ivec3 cube(glm::floor((glm::dvec3(position) - centre_) * per_metre_));
    const glm::vec3 steep = glm::abs(normal);
    const int axis = steep.x > steep.y ? (steep.x > steep.z ? 0 : 2) : (steep.y > steep.z ? 1 : 2);
    return {cube.x, cube.y, cube.z, 2 * axis + (normal[axis] > 0 ? 1 : 0)};
  }

 private:
  static constexpr int most_halvings = 24;

  glm::dvec3 centre_;
  double per_metre_;
};

}  // namespace photile::trace
