#include "geometry/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace photile::geometry {
namespace {

constexpr std::uint32_t leaf_size = 4;

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!boxes.empty()) build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(std::span<const Box> boxes, std::uint32_t first, std::uint32_t last) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  Box all, centres;
  for (std::uint32_t i = first; i < last; ++i) {
    const Box& box = boxes[order_[i]];
    all.extend(box);
    centres.extend(box.lower + box.upper);
  }
  nodes_[node].box = all;
  if (last - first <= leaf_size) {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  const glm::vec3 extent = centres.upper - centres.lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return boxes[a].lower[axis] + boxes[a].upper[axis] <
                            boxes[b].lower[axis] + boxes[b].upper[axis];
                   });
  build(boxes, first, middle);
  nodes_[node].first = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, middle, last);
}

}  // namespace photile::geometry
