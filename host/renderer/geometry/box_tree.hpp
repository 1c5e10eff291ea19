// A binary tree over boxes, for "is any of them within R": nearer children are visited first, until
// a visit ends the search.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/box.hpp"
#include "photile/scene.hpp"

namespace photile::geometry {

Box triangle_box(const Scene& scene, std::uint32_t triangle);
/// Of all triangles.
std::vector<Box> triangle_boxes(const Scene& scene);

/// Split at the median of the boxes' centres along the longest axis, down to leaves of 4. Large
/// trees are built in parallel; what is visited, and in which order, does not depend on it.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes);

  /// Calls visit(index of a box) for boxes in leaves at most `limit` (squared metres) from `box`,
  /// until it returns true.
  template <class Visit>
  void visit_within(const Box& box, float limit, Visit&& visit) const {
    visit_within(
        box, limit, [](std::size_t) { return true; }, visit);
  }

  /// The same, without nodes that enter(node) rejects and all nodes below them.
  template <class Enter, class Visit>
  void visit_within(const Box& box, float limit, Enter&& enter, Visit&& visit) const {
    if (nodes_.empty() || !(squared_distance(nodes_[0].box, box) <= limit)) return;
    std::array<std::uint32_t, 64> stack;  // halves: at most 32 levels
    std::size_t depth = 0;
    std::uint32_t node = 0;
    for (;;) {
      const Node& here = nodes_[node];
      if (!enter(node)) {
      } else if (here.count != 0) {
        for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
          if (visit(order_[i])) return;
        }
      } else {
        std::uint32_t near = here.first, far = here.first + 1;
        float near_distance = squared_distance(nodes_[near].box, box);
        float far_distance = squared_distance(nodes_[far].box, box);
        if (far_distance < near_distance) {
          std::swap(near, far);
          std::swap(near_distance, far_distance);
        }
        if (far_distance <= limit) stack[depth++] = far;
        if (near_distance <= limit) {
          node = near;
          continue;
        }
      }
      if (depth == 0) return;
      node = stack[--depth];
    }
  }

  /// Per node, the values of(index of a box) of all boxes below it, combined by join(a, b).
  template <class Value, class Of, class Join>
  std::vector<Value> folded(const Value& of_none, const Of& of, const Join& join) const {
    std::vector<Value> values(nodes_.size(), of_none);
    for (std::size_t node = nodes_.size(); node-- > 0;) {  // children come after their parents
      const Node& here = nodes_[node];
      if (here.count == 0) values[node] = join(values[here.first], values[here.first + 1]);
      for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
        values[node] = join(values[node], of(order_[i]));
      }
    }
    return values;
  }

  /// Calls visit(index of a box) for all boxes that overlap `box`.
  ///   boxes   those from which the tree was built
  template <class Visit>
  void visit_overlapping(std::span<const Box> boxes, const Box& box, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth != 0) {
      const Node& here = nodes_[stack[--depth]];
      if (here.count != 0) {
        for (std::uint32_t i = here.first; i < here.first + here.count; ++i) {
          if (overlap(boxes[order_[i]], box)) visit(order_[i]);
        }
        continue;
      }
      for (const std::uint32_t child : {here.first, here.first + 1}) {
        stack[depth] = child;
        depth += overlap(nodes_[child].box, box) ? 1 : 0;
      }
    }
  }

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< of a leaf's boxes in the order; else of the two children
    std::uint32_t count = 0;  ///< of a leaf's boxes; 0 in inner nodes
  };
  class Builder;

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace photile::geometry
