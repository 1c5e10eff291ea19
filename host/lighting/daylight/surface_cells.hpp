// Surface in cells, each of which reflects the same light to all rays that end in it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/surface.hpp"

namespace photile::daylight {

/// Cells are cubes of space times a range of normals; whatever of their surface a cell's first
/// point does not see belongs to another cell, so that walls without thickness and shelves separate
/// light. Far from where rays start cells are larger. They depend on the points and their order.
class SurfaceCells {
 public:
  /// Ends of rays in a cell that its own rays may start from.
  static constexpr std::size_t most_places = 64;

  /// References are kept.
  ///   size   metres of the smallest cells
  ///   near   metres: rays up to twice this long end in the smallest
  SurfaceCells(const RayScene& rays, double size, double near);

  /// The cell of a point where a ray of this length ends, in metres.
  std::uint32_t cell_of(const trace::SurfacePoint& point, float length);

  std::size_t size() const { return cells_.size(); }
  /// How many rays have ended there.
  std::uint32_t ends(std::size_t cell) const { return cells_[cell].ends; }
  /// Some of those ends, evenly chosen.
  std::span<const trace::SurfacePoint> places(std::size_t cell) const {
    return cells_[cell].places;
  }

 private:
  struct Cell {
    glm::vec3 sight;       ///< just before its first point
    std::uint32_t beside;  ///< another one in the same cube, or `none`
    std::uint32_t ends = 0;
    std::vector<trace::SurfacePoint> places;
  };
  std::uint32_t find(std::uint64_t cube, const trace::SurfacePoint& point, double cell_size);

  const RayScene& rays_;
  double size_, near_;
  std::vector<Cell> cells_;
  std::unordered_map<std::uint64_t, std::uint32_t> in_cube_;  ///< the first of them
};

}  // namespace photile::daylight
