#include "surface/surface_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>

namespace photile::surface {
namespace {

using geometry::Box;

constexpr std::size_t width = PHOTILE_SURFACE_WIDTH;
constexpr int bin_count = 16;
/// Below this depth splits are at the median, an eighth for each child, so that the tree is never
/// deeper than this and log_8 of the pieces: 10 + 10 levels, for which the stack has room.
constexpr int heuristic_depth = 10;
static_assert((width - 1) * (heuristic_depth + 10) + 1 <= PHOTILE_SURFACE_STACK);

struct Range {
  std::span<std::uint32_t> pieces;
  Box box;
};

/// Ranges of more pieces are split by separate tasks.
constexpr std::size_t pieces_per_task = 2048;

class TreeBuilder {
 public:
  explicit TreeBuilder(const std::vector<SurfacePiece>& pieces) : pieces_(pieces) {}

  Range range_of(std::span<std::uint32_t> pieces) const {
    Range range{pieces, {}};
    for (const std::uint32_t i : pieces) range.box.extend(pieces_[i].box);
    return range;
  }

  /// Appends the node of more than eight pieces, or any for the root, and all below it. Returns its
  /// number.
  std::uint32_t add_node(const Range& range, int depth, SurfaceTree& tree) const {
    const std::vector<Range> children = children_of(range, depth);
    const auto node = static_cast<std::uint32_t>(tree.nodes.size());
    tree.nodes.emplace_back();
    std::array<std::uint32_t, width> links;
    if (range.pieces.size() > pieces_per_task) {
      std::array<SurfaceTree, width> below;
      tbb::parallel_for(std::size_t{0}, children.size(),
                        [&](std::size_t i) { add_child(children[i], depth, below[i]); });
      for (std::size_t i = 0; i < children.size(); ++i) links[i] = append(below[i], tree);
    } else {
      for (std::size_t i = 0; i < children.size(); ++i) {
        links[i] = add_child(children[i], depth, tree);
      }
    }
    for (std::size_t i = 0; i < width; ++i) {
      const bool used = i < children.size();
      const Box box = used ? children[i].box : Box{};
      PhotileSurfaceNode& made = tree.nodes[node];
      made.lower_x[i] = box.lower.x, made.lower_y[i] = box.lower.y, made.lower_z[i] = box.lower.z;
      made.upper_x[i] = box.upper.x, made.upper_y[i] = box.upper.y, made.upper_z[i] = box.upper.z;
      made.child[i] = used ? links[i] : PHOTILE_SURFACE_NONE;
    }
    return node;
  }

 private:
  /// Appends a node or a leaf; returns the link to it.
  std::uint32_t add_child(const Range& range, int depth, SurfaceTree& tree) const {
    if (range.pieces.size() > width) return add_node(range, depth + 1, tree);
    tree.leaves.emplace_back(range.pieces.begin(), range.pieces.end());
    return static_cast<std::uint32_t>(tree.leaves.size() - 1) | PHOTILE_SURFACE_LEAF;
  }

  /// Appends what add_child left in a separate tree; returns the link to it, as if it had been
  /// added here.
  static std::uint32_t append(SurfaceTree& child, SurfaceTree& tree) {
    const auto first_node = static_cast<std::uint32_t>(tree.nodes.size());
    const auto first_leaf = static_cast<std::uint32_t>(tree.leaves.size());
    for (PhotileSurfaceNode& node : child.nodes) {
      for (std::uint32_t& link : node.child) {
        if (link == PHOTILE_SURFACE_NONE) continue;
        link += (link & PHOTILE_SURFACE_LEAF) != 0 ? first_leaf : first_node;
      }
    }
    tree.nodes.insert(tree.nodes.end(), child.nodes.begin(), child.nodes.end());
    std::move(child.leaves.begin(), child.leaves.end(), std::back_inserter(tree.leaves));
    return child.nodes.empty() ? first_leaf | PHOTILE_SURFACE_LEAF : first_node;
  }

  /// At most eight parts: again and again the one with the largest surface is split.
  std::vector<Range> children_of(const Range& range, int depth) const {
    std::vector<Range> children{range};
    while (children.size() < width) {
      std::size_t largest = children.size();
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (children[i].pieces.size() <= width) continue;
        if (largest == children.size() ||
            priority(children[i], depth) > priority(children[largest], depth)) {
          largest = i;
        }
      }
      if (largest == children.size()) break;
      const std::size_t middle = split(children[largest], depth);
      const std::span<std::uint32_t> all = children[largest].pieces;
      children[largest] = range_of(all.first(middle));
      children.insert(children.begin() + static_cast<std::ptrdiff_t>(largest) + 1,
                      range_of(all.subspan(middle)));
    }
    return children;
  }

  static float priority(const Range& range, int depth) {
    return depth < heuristic_depth ? range.box.half_area()
                                   : static_cast<float>(range.pieces.size());
  }

  glm::vec3 centre(std::uint32_t piece) const {
    return 0.5f * (pieces_[piece].box.lower + pieces_[piece].box.upper);
  }

  /// Reorders the pieces of the range; returns how many come first.
  std::size_t split(const Range& range, int depth) const {
    Box centres;
    for (const std::uint32_t i : range.pieces) centres.extend(centre(i));
    if (depth < heuristic_depth) {
      const std::size_t middle = split_by_area(range, centres);
      if (middle > 0) return middle;
    }
    const int axis = centres.longest_axis();
    std::stable_sort(
        range.pieces.begin(), range.pieces.end(),
        [&](std::uint32_t a, std::uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
    return range.pieces.size() / 2;
  }

  /// 0 where all centres coincide.
  std::size_t split_by_area(const Range& range, const Box& centres) const {
    float best = std::numeric_limits<float>::infinity();
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centres.upper[axis] > centres.lower[axis])) continue;
      std::array<Box, bin_count> boxes;
      std::array<std::size_t, bin_count> counts{};
      for (const std::uint32_t i : range.pieces) {
        const int bin = bin_of(i, axis, centres);
        boxes[bin].extend(pieces_[i].box);
        ++counts[bin];
      }
      std::array<float, bin_count> above{};  // cost of the bins from here on
      Box box;
      std::size_t count = 0;
      for (int bin = bin_count - 1; bin > 0; --bin) {
        box.extend(boxes[bin]);
        count += counts[bin];
        above[bin] = count == 0 ? 0.0f : box.half_area() * static_cast<float>(count);
      }
      box = {};
      count = 0;
      for (int bin = 0; bin + 1 < bin_count; ++bin) {
        box.extend(boxes[bin]);
        count += counts[bin];
        if (count == 0 || count == range.pieces.size()) continue;
        const float cost = box.half_area() * static_cast<float>(count) + above[bin + 1];
        if (cost < best) best = cost, best_axis = axis, best_bin = bin;
      }
    }
    if (best_axis < 0) return 0;
    const auto middle = std::stable_partition(
        range.pieces.begin(), range.pieces.end(),
        [&](std::uint32_t i) { return bin_of(i, best_axis, centres) <= best_bin; });
    return static_cast<std::size_t>(middle - range.pieces.begin());
  }

  int bin_of(std::uint32_t piece, int axis, const Box& centres) const {
    const float position =
        (centre(piece)[axis] - centres.lower[axis]) / (centres.upper[axis] - centres.lower[axis]);
    return std::clamp(static_cast<int>(position * bin_count), 0, bin_count - 1);
  }

  const std::vector<SurfacePiece>& pieces_;
};

}  // namespace

SurfaceTree build_surface_tree(const std::vector<SurfacePiece>& pieces) {
  SurfaceTree tree;
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  const TreeBuilder builder(pieces);
  builder.add_node(builder.range_of(order), 0, tree);
  return tree;
}

}  // namespace photile::surface
