#include "maps/map_tiling.hpp"

#include <algorithm>
#include <cmath>

#include "photile/scene.hpp"

namespace photile::maps {

namespace {

/// The smallest tiles must be smaller by this than what is to be cut into them.
constexpr double worthwhile = 0.9;

std::uint32_t divided_up(std::uint32_t a, std::uint32_t b) { return (a + b - 1) / b; }

}  // namespace

MapTiling::MapTiling(const PhotileGrid& grid, double radius)
    : grid_(grid),
      bin_height_(divided_up(std::max(divided_up(grid.columns, PHOTILE_CELL_ASPECT), grid.rows),
                             most_bins)),
      columns_(divided_up(grid.columns, bin_width())),
      rows_(divided_up(grid.rows, bin_height_)),
      map_of_bin_(std::size_t{columns_} * rows_, none) {
  // Queries look at the cells within the radius and the slack of a hit
  // (kernels/estimate/block.clh). The slack twice more: rounding may put hits, and the ends of
  // their cells, beyond the borders.
  const double rows = (radius + 3 * double{grid.slack}) / double{grid.cell_height};
  border_ = static_cast<std::uint32_t>(
      std::min<double>(most_bins, std::ceil(rows / static_cast<double>(bin_height_))));
}

void MapTiling::set_photons(std::span<const std::uint32_t> counts) {
  const std::size_t stride = columns_ + std::size_t{1};
  sums_.assign(stride * (rows_ + std::size_t{1}), 0);
  for (std::size_t row = 0; row < rows_; ++row) {
    std::uint64_t in_row = 0;
    for (std::size_t column = 0; column < columns_; ++column) {
      in_row += counts[row * columns_ + column];
      sums_[(row + 1) * stride + column + 1] = sums_[row * stride + column + 1] + in_row;
    }
  }
}

Rectangle MapTiling::grown(const Rectangle& tile) const {
  return {tile.first_column - std::min(border_, tile.first_column),
          tile.first_row - std::min(border_, tile.first_row),
          std::min(columns_, tile.last_column + border_), std::min(rows_, tile.last_row + border_)};
}

std::uint64_t MapTiling::photons(const Rectangle& tile) const {
  const Rectangle r = grown(tile);
  const auto before = [&](std::uint32_t column, std::uint32_t row) {
    return sums_[row * (columns_ + std::size_t{1}) + column];
  };
  return before(r.last_column, r.last_row) - before(r.first_column, r.last_row) -
         before(r.last_column, r.first_row) + before(r.first_column, r.first_row);
}

Rectangle MapTiling::cells(const Rectangle& tile) const {
  const Rectangle bins = grown(tile);
  return {bins.first_column * bin_width(), bins.first_row * bin_height_,
          std::min(grid_.columns, bins.last_column * bin_width()),
          std::min(grid_.rows, bins.last_row * bin_height_)};
}

std::uint64_t MapTiling::entries(const Rectangle& tile) const {
  constexpr std::uint64_t gap = 8;  // entries of a row that stand for none, on average
  const std::uint64_t held = photons(tile);
  const Rectangle of_page = cells(tile);
  const bool gaps = held > 0 && of_page.width() < grid_.columns;
  return held + (gaps ? gap * of_page.height() : 0);
}

PhotileGrid MapTiling::page_grid(const Rectangle& tile) const {
  PhotileGrid grid = grid_;
  // Indices are sums modulo 2^32: the first cell of the tile's first row gets 0.
  grid.first_cell = 0u - cells(tile).first_row * grid.columns;
  return grid;
}

std::uint64_t MapTiling::least_entries(const Rectangle& tile) const {
  std::uint64_t of_bins = 0, of_rows = 0;
  for (std::uint32_t row = tile.first_row; row < tile.last_row; ++row) {
    of_rows = std::max(of_rows, entries({tile.first_column, row, tile.last_column, row + 1}));
    for (std::uint32_t column = tile.first_column; column < tile.last_column; ++column) {
      of_bins = std::max(of_bins, entries({column, row, column + 1, row + 1}));
    }
  }
  return std::min(of_bins, of_rows);
}

std::optional<std::pair<Rectangle, Rectangle>> MapTiling::halves(const Rectangle& tile) const {
  if (static_cast<double>(least_entries(tile)) > worthwhile * static_cast<double>(entries(tile))) {
    return std::nullopt;
  }
  std::pair by_rows(tile, tile), by_columns(tile, tile);
  by_rows.first.last_row = by_rows.second.first_row = tile.first_row + tile.height() / 2;
  by_columns.first.last_column = by_columns.second.first_column =
      tile.first_column + tile.width() / 2;
  if (tile.height() == 1) return by_columns;
  if (tile.width() == 1) return by_rows;
  const auto cost = [&](const auto& halves) {
    return entries(halves.first) + entries(halves.second);
  };
  return cost(by_rows) <= cost(by_columns) ? by_rows : by_columns;
}

void MapTiling::assign(const Rectangle& tile, std::uint32_t map) {
  for (std::uint32_t row = tile.first_row; row < tile.last_row; ++row) {
    const auto begin = map_of_bin_.begin() + static_cast<std::ptrdiff_t>(row * columns_);
    std::fill(begin + tile.first_column, begin + tile.last_column, map);
  }
}

std::size_t MapTiling::bin_of(const glm::vec3& position) const {
  const glm::uvec2 cell = cell_of(position, grid_);
  return std::size_t{cell.y / bin_height_} * columns_ + cell.x / bin_width();
}

}  // namespace photile::maps
