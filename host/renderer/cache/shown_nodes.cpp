#include "cache/shown_nodes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>

#include "cache/charts.hpp"
#include "photile/scene.hpp"

namespace photile::cache {
namespace {

/// A corner of a cell may be this many times as bright as all others.
constexpr double most_over_others = 3;

/// The least weight of a node, so that some corner of each cell counts.
constexpr float least_weight = 1e-3f;

double luminance_of(const glm::vec4& light) { return luminance(glm::dvec3(light)); }

/// Of the 64 cells of a tile, y * 8 + x.
constexpr std::uint64_t first_column = 0x0101010101010101, first_row = 0xff;

std::uint64_t undivided(const Tile& tile) { return tile.known & ~tile.split; }

/// Cells of a tile beside which, on one side, there is a cell of their level that is not split.
struct Beside {
  std::uint64_t left = 0, right = 0, below = 0, above = 0;
};

Beside undivided_beside(const Tiles& tiles, const Tile& tile) {
  const auto beyond = [&](std::uint32_t columns, std::uint32_t rows) {
    const std::uint32_t index =
        tiles.tile_at(tile.chart, tile.level, tile.x + columns, tile.y + rows);
    return index == none ? 0 : undivided(tiles[index]);
  };
  const std::uint64_t own = undivided(tile);
  return {.left = (own & ~(first_column << 7)) << 1 | (beyond(-8u, 0) >> 7 & first_column),
          .right = (own & ~first_column) >> 1 | (beyond(8, 0) & first_column) << 7,
          .below = own << 8 | beyond(0, -8u) >> 56,
          .above = own >> 8 | (beyond(0, 8) & first_row) << 56};
}

}  // namespace

class ShownNodes::Softening {
 public:
  Softening(const LightMaps& maps, ShownNodes& nodes)
      : maps_(maps),
        tiles_(maps.tiles()),
        nodes_(nodes),
        brightest_other_(nodes.weight_.size()),
        is_mean_(nodes.weight_.size()) {}

  /// A cell that was lacking: what is still lacking within it.
  void add(std::uint32_t tile_index, std::uint32_t cell) {
    const Tile& tile = tiles_[tile_index];
    const std::uint32_t column = cell & 7, row = cell >> 3;
    if ((tile.known >> cell & 1) != 0) {
      if ((tile.split >> cell & 1) == 0) return;
      const std::uint32_t child = tile.child[(row >> 2) * 2 + (column >> 2)];
      const std::uint32_t first = (row & 3) * 16 + (column & 3) * 2;
      for (const std::uint32_t part : {first, first + 1, first + 8, first + 9}) add(child, part);
      return;
    }
    if (tile.level == 0) return;  // there is no larger cell to be seen
    const std::uint32_t x = tile.x + column, y = tile.y + row;
    std::array<std::uint32_t, 4> shown;
    for (std::uint32_t i = 0; i < 4; ++i) {
      shown[i] = tiles_.node(tile.chart, tile.level - 1, (x >> 1) + (i & 1), (y >> 1) + (i >> 1));
      nodes_.lacks_beside_[shown[i]] = 1;
    }
    add_shown(shown, tile.level - 1);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t at_x = x + (corner & 1), at_y = y + (corner >> 1);
      if (((at_x | at_y) & 1) == 0) continue;  // a corner of the larger cell, too
      const std::uint32_t node = tiles_.node(tile.chart, tile.level, at_x, at_y);
      if (node != none) is_mean_[node] = nodes_.lacks_beside_[node] = 1;
    }
  }

  /// All cells that show their own nodes.
  void add_all_undivided() {
    borders_ = true;
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
      const Tile& tile = tiles_[i];
      for (std::uint64_t cells = undivided(tile); cells != 0; cells &= cells - 1) {
        add_shown(tile.corners(static_cast<std::uint32_t>(std::countr_zero(cells))), tile.level);
      }
    }
  }

  void apply() {
    for (std::size_t node = 0; node < brightest_other_.size(); ++node) {
      const double own = luminance_of(nodes_.light_[node]);
      const double most = most_over_others * brightest_other_[node];
      if (own <= most || most == 0) continue;
      const auto fraction = static_cast<float>(most / own);
      nodes_.light_[node] *= fraction;
      if (!nodes_.by_normal_.empty()) nodes_.by_normal_[node] *= fraction;
    }
    // A tile comes after the one that it refines: nodes are known before those between them.
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
      const Tile& tile = tiles_[i];
      const std::uint64_t refined = tile.known & tile.split;
      if (refined == 0) continue;
      const Beside beside = borders_ ? undivided_beside(tiles_, tile) : Beside{};
      for (std::uint64_t cells = refined; cells != 0; cells &= cells - 1) {
        take_means(tile, static_cast<std::uint32_t>(std::countr_zero(cells)), beside);
      }
    }
  }

 private:
  /// The corners of a cell that a picture reads.
  void add_shown(const std::array<std::uint32_t, 4>& nodes, std::uint32_t level) {
    const auto spacing =
        static_cast<float>(std::ldexp(maps_.charts().spacing(), -static_cast<int>(level)));
    const std::span<const glm::vec4> light = nodes_.held_.light();
    for (const std::uint32_t node : nodes) {
      nodes_.weight_[node] =
          std::min(nodes_.weight_[node], std::max(least_weight, maps_.distance(node) / spacing));
      for (const std::uint32_t other : nodes) {
        if (other == node) continue;
        brightest_other_[node] = std::max(brightest_other_[node], luminance_of(light[other]));
      }
    }
  }

  /// Gives nodes within a cell the mean of the corners between which they lie, where they are on
  /// the border of a larger cell, or one of those corners is.
  void take_means(const Tile& tile, std::uint32_t cell, const Beside& beside) {
    const std::uint32_t column = cell & 7, row = cell >> 3;
    const Tile& child = tiles_[tile.child[(row >> 2) * 2 + (column >> 2)]];
    const std::array<std::uint32_t, 4> corners = tile.corners(cell);
    const std::uint32_t* nodes = &child.node[(row & 3) * 18 + (column & 3) * 2];
    take_mean(nodes[1], beside.below >> cell & 1, {corners[0], corners[1]});
    take_mean(nodes[9], beside.left >> cell & 1, {corners[0], corners[2]});
    take_mean(nodes[10], false, {corners[0], corners[1], corners[2], corners[3]});
    take_mean(nodes[11], beside.right >> cell & 1, {corners[1], corners[3]});
    take_mean(nodes[19], beside.above >> cell & 1, {corners[2], corners[3]});
  }

  void take_mean(std::uint32_t node, bool on_border, std::initializer_list<std::uint32_t> corners) {
    if (node == none) return;
    const auto is_one_of = [&](std::span<const std::uint8_t> those) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](std::uint32_t corner) { return those[corner] != 0; });
    };
    if (!on_border && is_mean_[node] == 0 && !is_one_of(is_mean_)) return;
    is_mean_[node] = 1;
    if (is_one_of(nodes_.lacks_beside_)) nodes_.lacks_beside_[node] = 1;
    float sum = 0;
    glm::vec4 light(0.0f), by_normal(0.0f);
    for (const std::uint32_t corner : corners) {
      const float weight = nodes_.weight_[corner];
      sum += weight;
      light += weight * nodes_.light_[corner];
      if (!nodes_.by_normal_.empty()) by_normal += weight * nodes_.by_normal_[corner];
    }
    nodes_.weight_[node] = sum / static_cast<float>(corners.size());
    nodes_.light_[node] = light / sum;
    if (!nodes_.by_normal_.empty()) nodes_.by_normal_[node] = by_normal / sum;
  }

  const LightMaps& maps_;
  const Tiles& tiles_;
  ShownNodes& nodes_;
  bool borders_ = false;                 ///< also of cells that lack nothing
  std::vector<double> brightest_other_;  ///< per node: of the cells that it is a corner of
  std::vector<std::uint8_t> is_mean_;    ///< per node: of the nodes between which it lies
};

void ShownNodes::mix(const LightMaps& maps, std::span<const glm::vec3> powers,
                     std::span<const MissingCell> lacking, bool everywhere) {
  const std::size_t nodes = maps.statistics().nodes;
  const std::size_t softened = everywhere || !lacking.empty() ? nodes : 0;
  const bool is_known =
      lacking.empty() && light_.size() == nodes && weight_.size() == softened &&
      std::equal(powers.begin(), powers.end(), held_.powers().begin(), held_.powers().end());
  if (is_known) return;
  held_.mix(maps.values(), nodes, powers);
  light_.assign(held_.light().begin(), held_.light().end());
  by_normal_.assign(held_.by_normal().begin(), held_.by_normal().end());
  weight_.assign(softened, 1.0f);
  lacks_beside_.assign(softened, 0);
  if (softened == 0) return;
  Softening softening(maps, *this);
  for (const MissingCell& cell : lacking) softening.add(cell.tile, cell.cell);
  if (everywhere) softening.add_all_undivided();
  softening.apply();
}

bool ShownNodes::lacks_beside(const BilinearWeights& bilinear) const {
  return !lacks_beside_.empty() &&
         std::any_of(bilinear.node.begin(), bilinear.node.end(),
                     [&](std::uint32_t node) { return lacks_beside_[node] != 0; });
}

BilinearWeights ShownNodes::weighted(BilinearWeights bilinear) const {
  if (weight_.empty()) return bilinear;
  float sum = 0;
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    sum += bilinear.weight[i] *= weight_[bilinear.node[i]];
  }
  for (float& weight : bilinear.weight) weight /= sum;
  return bilinear;
}

}  // namespace photile::cache
