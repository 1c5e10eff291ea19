// Where a point falls in a grid, as kernels/grid/cell.clh computes it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

#include "photile/device/grid.h"

namespace photile::maps {

/// Coordinates in the plane of a grid, metres.
inline glm::vec2 project(const glm::vec3& p, const PhotileGrid& grid) {
  const glm::vec3 local = p - glm::vec3(grid.origin_x, grid.origin_y, grid.origin_z);
  return {glm::dot(local, glm::vec3(grid.u_axis_x, grid.u_axis_y, grid.u_axis_z)),
          glm::dot(local, glm::vec3(grid.v_axis_x, grid.v_axis_y, grid.v_axis_z))};
}

/// Column and row, clamped to the grid.
inline glm::uvec2 cell_of(const glm::vec3& p, const PhotileGrid& grid) {
  const glm::vec2 uv = project(p, grid);
  const auto index = [&](float coordinate, float minimum, float inverse_size, std::uint32_t count) {
    const float place = (coordinate - minimum) * inverse_size;
    return static_cast<std::uint32_t>(std::clamp(place, 0.0f, static_cast<float>(count - 1)));
  };
  return {index(uv.x, grid.minimum_u, grid.inverse_cell_width, grid.columns),
          index(uv.y, grid.minimum_v, grid.inverse_cell_height, grid.rows)};
}

}  // namespace photile::maps
