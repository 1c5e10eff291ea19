// A photon map that is too large for one page, cut into tiles, and the cell of a grid that a point
// falls in, as kernels/grid/cell.clh computes it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "photile/device/grid.h"

namespace photile::maps {

/// Columns and rows [first, last), of a grid's cells or of bins of them.
struct Rectangle {
  std::uint32_t first_column = 0, first_row = 0, last_column = 0, last_row = 0;

  std::uint32_t width() const { return last_column - first_column; }
  std::uint32_t height() const { return last_row - first_row; }
};

/// Tiles of a map: disjoint rectangles of bins, which are squares of whole cells. The page of a
/// tile holds the photons within the radius of the tile, and hits on the tile find all their
/// neighbours there: by the same grid, in the same cells and the same lanes of vectors as in the
/// undivided map, hence with the same bits (kernels/grid/tile.clh).
class MapTiling {
 public:
  static constexpr std::uint32_t most_bins = 64;  ///< per side

  /// `radius`: metres, of the search.
  MapTiling(const PhotileGrid& grid, double radius);

  const PhotileGrid& grid() const { return grid_; }
  /// Columns of cells in a bin.
  std::uint32_t bin_width() const { return PHOTILE_CELL_ASPECT * bin_height_; }
  std::uint32_t bin_height() const { return bin_height_; }  ///< rows of cells in a bin
  std::uint32_t columns() const { return columns_; }        ///< of bins
  std::uint32_t rows() const { return rows_; }

  /// `counts`: photons per bin, in row-major order.
  void set_photons(std::span<const std::uint32_t> counts);

  Rectangle whole() const { return {0, 0, columns_, rows_}; }
  /// Photons within the radius of a tile, and a few more.
  std::uint64_t photons(const Rectangle& tile) const;
  /// The cells that photons of a tile's page lie in. It has all cells of their rows.
  Rectangle cells(const Rectangle& tile) const;
  /// Entries of a tile's page, about: photons, and what gaps between rows take.
  std::uint64_t entries(const Rectangle& tile) const;
  /// The grid for the page of a tile: indices of its cells begin with those of the tile's first
  /// row.
  PhotileGrid page_grid(const Rectangle& tile) const;

  /// The tile in two, across the side that leaves fewer entries; nothing where the smallest tiles
  /// would have hardly fewer than it has.
  std::optional<std::pair<Rectangle, Rectangle>> halves(const Rectangle& tile) const;

  /// Hits on the tile belong to map `map` from now on.
  void assign(const Rectangle& tile, std::uint32_t map);
  /// The map assigned to the point; `none` where no photon is near.
  std::uint32_t map_at(const glm::vec3& position) const { return map_of_bin_[bin_of(position)]; }

 private:
  Rectangle grown(const Rectangle& tile) const;
  /// Entries of the largest tile where this one is cut as far as possible.
  std::uint64_t least_entries(const Rectangle& tile) const;
  std::size_t bin_of(const glm::vec3& position) const;

  PhotileGrid grid_;
  std::uint32_t bin_height_ = 1, columns_ = 1, rows_ = 1;
  std::uint32_t border_ = 0;         ///< bins around a tile that its hits may find photons in
  std::vector<std::uint64_t> sums_;  ///< of photons in all bins before a column and a row
  std::vector<std::uint32_t> map_of_bin_;
};

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
