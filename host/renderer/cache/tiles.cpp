#include "cache/tiles.hpp"

namespace photile::cache {
namespace {

/// The chart of a root: the last whose first root is not beyond it.
std::uint32_t chart_of_root(const Charts& charts, std::uint32_t root) {
  std::size_t low = 0, high = charts.size();
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (charts[middle].first_root <= root ? low : high) = middle;
  }
  return static_cast<std::uint32_t>(low);
}

}  // namespace

std::uint32_t Tiles::tile_of(const MissingCell& missing) {
  if (missing.has_tile) return missing.tile;
  const std::uint32_t root = missing.tile;
  if (root_[root] == none) {
    const std::uint32_t chart = chart_of_root(charts_, root);
    const std::uint32_t number = root - charts_[chart].first_root;
    const std::uint32_t columns = charts_[chart].root_columns();
    root_[root] = add(chart, 0, number % columns * 8, number / columns * 8);
  }
  return root_[root];
}

void Tiles::split(std::uint32_t tile, std::uint32_t cell) {
  tiles_[tile].split |= std::uint64_t{1} << cell;
  const std::uint32_t right = (cell & 7) >> 2, up = cell >> 5, quadrant = up * 2 + right;
  if (tiles_[tile].child[quadrant] != none) return;
  const Tile& parent = tiles_[tile];
  const std::uint32_t child =
      add(parent.chart, parent.level + 1, 2 * parent.x + 8 * right, 2 * parent.y + 8 * up);
  tiles_[tile].child[quadrant] = child;
}

void Tiles::keep(std::span<const std::uint64_t> cells, std::span<const std::uint32_t> number) {
  // A tile without cells stays where a cell that stays is split into it.
  std::vector<std::uint8_t> stays(tiles_.size(), 0);
  std::vector<std::uint32_t> tile_number(tiles_.size(), none);
  std::uint32_t kept = 0;
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    if (cells[index] != 0) stays[index] = 1;
    if (stays[index] != 0) tile_number[index] = kept++;
    const std::uint64_t split = tiles_[index].split & cells[index];
    for (std::uint32_t quadrant = 0; quadrant < 4; ++quadrant) {
      const std::uint64_t own = std::uint64_t{0x0F0F0F0F}
                                << ((quadrant >> 1) * 32 + (quadrant & 1) * 4);
      if ((split & own) != 0) stays[tiles_[index].child[quadrant]] = 1;
    }
  }
  const auto renumber = [](std::uint32_t& old, std::span<const std::uint32_t> numbers) {
    if (old != none) old = numbers[old];
  };
  for (std::uint32_t& root : root_) renumber(root, tile_number);
  for (std::size_t index = 0; index < tiles_.size(); ++index) {
    if (tile_number[index] == none) continue;
    Tile tile = tiles_[index];
    tile.known = cells[index];
    tile.split &= cells[index];
    for (std::uint32_t& child : tile.child) renumber(child, tile_number);
    for (std::uint32_t& node : tile.node) renumber(node, number);
    tiles_[tile_number[index]] = tile;
  }
  tiles_.resize(kept);
}

std::uint32_t Tiles::tile_at(std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                             std::uint32_t y) const {
  const Chart& lattice = charts_[chart];
  const std::uint32_t column = x >> level >> 3, row = y >> level >> 3;
  if (column >= lattice.root_columns() || row >= lattice.root_rows()) return none;
  std::uint32_t tile = root_[lattice.first_root + row * lattice.root_columns() + column];
  for (std::uint32_t finer = level; finer > 0 && tile != none; --finer) {
    const std::uint32_t right = x >> finer >> 2 & 1, up = y >> finer >> 2 & 1;
    tile = tiles_[tile].child[up * 2 + right];
  }
  return tile;
}

std::uint32_t Tiles::node(std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                          std::uint32_t y) const {
  for (std::uint32_t around = 0; around < 4; ++around) {
    const std::uint32_t left = around & 1, below = around >> 1;
    if (x < left || y < below) continue;
    const std::uint32_t index = tile_at(chart, level, x - left, y - below);
    if (index == none) continue;
    const Tile& tile = tiles_[index];
    const std::uint32_t node = tile.node[(y - tile.y) * 9 + x - tile.x];
    if (node != none) return node;
  }
  return none;
}

std::uint32_t Tiles::add(std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                         std::uint32_t y) {
  Tile tile;
  tile.chart = chart;
  tile.level = level;
  tile.x = x;
  tile.y = y;
  tile.node.fill(none);
  tiles_.push_back(tile);
  return static_cast<std::uint32_t>(tiles_.size() - 1);
}

}  // namespace photile::cache
