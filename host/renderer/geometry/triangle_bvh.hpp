// A bounding volume hierarchy over triangles, for "which are within R of this box".
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/box.hpp"
#include "photile/scene.hpp"

namespace photile::geometry {

Box triangle_box(const Scene& scene, std::uint32_t triangle);

/// A complete binary tree over the triangles in the order of extended Morton codes (Vinkler et al.
/// 2017): size class first, then position. The size keeps a wall out of the leaves of the pencils
/// beside it. Node i has the children 2 i and 2 i + 1; the root is node 1.
class TriangleBvh {
 public:
  static constexpr std::uint32_t leaf_size = 8;

  explicit TriangleBvh(const Scene& scene);

  /// Triangles in leaf order: leaf l holds order()[l * leaf_size] and those after it.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Nodes from leaf_count() on are the leaves.
  std::uint32_t leaf_count() const { return leaf_count_; }

  /// Calls visit(first, last), positions in order(), for leaves at most `radius` metres from `box`,
  /// until it returns true. Nodes that enter(node) denies are left out with all below them.
  template <class Enter, class Visit>
  void visit_within(const Box& box, double radius, Enter&& enter, Visit&& visit) const {
    if (order_.empty()) return;
    // Room for the rounding of squared_distance(), a few parts in 10^7.
    const float limit = static_cast<float>(radius * radius * (1 + 1e-5));
    std::array<std::uint32_t, 2 * 32> stack;  // the tree has at most 32 levels
    std::size_t depth = 0;
    stack[depth++] = 1;
    while (depth != 0) {
      const std::uint32_t node = stack[--depth];
      if (!enter(node) || !(squared_distance(boxes_[node], box) <= limit)) continue;
      if (node < leaf_count_) {
        stack[depth++] = 2 * node + 1;
        stack[depth++] = 2 * node;
        continue;
      }
      const std::size_t first = std::size_t{node - leaf_count_} * leaf_size;
      if (visit(first, std::min(first + leaf_size, order_.size()))) return;
    }
  }

  /// Calls visit(first, last) for each leaf at most `radius` metres from `box`: positions in
  /// order().
  template <class Visit>
  void for_each_leaf_within(const Box& box, double radius, Visit&& visit) const {
    visit_within(
        box, radius, [](std::uint32_t) { return true; },
        [&](std::size_t first, std::size_t last) {
          visit(first, last);
          return false;
        });
  }

 private:
  std::vector<std::uint32_t> order_;
  std::uint32_t leaf_count_ = 0;  ///< a power of two; the last leaves may be empty
  std::vector<Box> boxes_;        ///< 2 * leaf_count_; boxes_[0] is not used
};

}  // namespace photile::geometry
