// Tiles of 8 x 8 cells: the nodes at their corners, and which of them are split.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cache/charts.hpp"

namespace photile::cache {

/// Four nodes and their weights, which sum to 1.
struct BilinearWeights {
  std::array<std::uint32_t, 4> node;
  std::array<float, 4> weight;
};

/// Cells of one level of a chart. Corner (x, y) of the tile is node[y * 9 + x].
struct Tile {
  std::uint64_t known = 0;  ///< cells that were compared: their corners have light
  std::uint64_t split = 0;  ///< of them, those that the next level refines
  std::array<std::uint32_t, 4> child{none, none, none, none};  ///< tiles of the four quadrants
  std::uint32_t chart = 0;
  std::uint32_t x = 0, y = 0;  ///< the tile's first cell, in cells of its level
  std::uint32_t level = 0;
  std::array<std::uint32_t, 81> node;

  /// Nodes of cell y * 8 + x: the first is that of least column and row.
  std::array<std::uint32_t, 4> corners(std::uint32_t cell) const {
    const std::uint32_t first = (cell >> 3) * 9 + (cell & 7);
    return {node[first], node[first + 1], node[first + 9], node[first + 10]};
  }
};

/// A cell that has not been compared yet.
struct MissingCell {
  std::uint32_t tile;  ///< or root, where the root has no tile
  std::uint32_t cell;  ///< y * 8 + x
  bool has_tile;
  friend auto operator<=>(const MissingCell&, const MissingCell&) = default;
};

class Tiles {
 public:
  explicit Tiles(const Charts& charts) : charts_(charts), root_(charts.roots(), none) {}

  /// The nodes around a position of a chart: of the cell that is not split, or of the last known
  /// cell above a missing one, which is then returned. Without any, the nodes are `none`.
  ///   levels   that are searched, the coarsest first
  std::optional<MissingCell> find(std::uint32_t chart, const glm::vec3& position,
                                  BilinearWeights& bilinear,
                                  int levels = std::numeric_limits<int>::max()) const {
    const Chart& lattice = charts_[chart];
    const glm::vec2 at = charts_.lattice(chart).of(position);
    const glm::uvec2 coarse = charts_.cell_at(chart, at);
    std::uint32_t x = coarse.x, y = coarse.y;
    glm::vec2 within = glm::clamp(at - glm::vec2(x, y), 0.0f, 1.0f);
    const std::uint32_t root = lattice.first_root + (y >> 3) * lattice.root_columns() + (x >> 3);
    x &= 7, y &= 7;
    bilinear.node[0] = none;
    std::uint32_t index = root_[root];
    if (index == none) return MissingCell{root, y * 8 + x, false};
    for (;;) {
      const Tile& tile = tiles_[index];
      const std::uint32_t cell = y * 8 + x;
      if ((tile.known >> cell & 1) == 0) return MissingCell{index, cell, true};
      const bool split = static_cast<int>(tile.level) + 1 < levels && (tile.split >> cell & 1) != 0;
      const std::uint32_t quadrant = (y >> 2) * 2 + (x >> 2);
      const glm::vec2 doubled = 2.0f * within;
      const std::uint32_t right = doubled.x >= 1.0f, up = doubled.y >= 1.0f;
      if (split) {
        const std::uint32_t child_cell = ((y & 3) * 2 + up) * 8 + (x & 3) * 2 + right;
        if ((tiles_[tile.child[quadrant]].known >> child_cell & 1) == 0) {
          bilinear_of(tile, x, y, within, bilinear);
          return MissingCell{tile.child[quadrant], child_cell, true};
        }
        index = tile.child[quadrant];
        x = (x & 3) * 2 + right, y = (y & 3) * 2 + up;
        within = doubled - glm::vec2(right, up);
        continue;
      }
      bilinear_of(tile, x, y, within, bilinear);
      return std::nullopt;
    }
  }

  /// The tile that has a cell of a level; none where there is none.
  ///   x, y   in cells of the level; those before the first, counted modulo 2^32, have no tile
  std::uint32_t tile_at(std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                        std::uint32_t y) const;
  /// The node at the corner of cells of a level, from any tile that has it; else none.
  ///   x, y   in cells of the level
  std::uint32_t node(std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                     std::uint32_t y) const;

  /// The tile of a missing cell, made if there is none.
  std::uint32_t tile_of(const MissingCell& missing);
  /// Makes the tile of the next level that refines a cell, if there is none.
  void split(std::uint32_t tile, std::uint32_t cell);

  /// Keeps the tiles that have cells to keep, in this order; each comes after the one that it
  /// refines, and nothing is kept without what is coarser there.
  ///   cells    per tile
  ///   number   per node: its new number; none where it goes
  void keep(std::span<const std::uint64_t> cells, std::span<const std::uint32_t> number);

  Tile& operator[](std::uint32_t tile) { return tiles_[tile]; }
  const Tile& operator[](std::uint32_t tile) const { return tiles_[tile]; }
  std::size_t size() const { return tiles_.size(); }
  std::uint64_t bytes() const {
    return root_.size() * sizeof(std::uint32_t) + tiles_.size() * sizeof(Tile);
  }

 private:
  static void bilinear_of(const Tile& tile, std::uint32_t x, std::uint32_t y,
                          const glm::vec2& within, BilinearWeights& bilinear) {
    bilinear.node = tile.corners(y * 8 + x);
    bilinear.weight = {(1 - within.x) * (1 - within.y), within.x * (1 - within.y),
                       (1 - within.x) * within.y, within.x * within.y};
  }

  std::uint32_t add(std::uint32_t chart, std::uint32_t level, std::uint32_t x, std::uint32_t y);

  const Charts& charts_;
  std::vector<std::uint32_t> root_;  ///< tiles of the coarsest level, or none
  std::vector<Tile> tiles_;
};

}  // namespace photile::cache
