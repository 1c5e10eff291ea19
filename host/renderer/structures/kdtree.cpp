#include "structures/kdtree.hpp"

#include <algorithm>

#include "structures/widest_axis.hpp"

namespace photile::maps {
namespace {

constexpr std::size_t leaf_size = 8;

class Builder {
 public:
  Builder(std::span<const glm::vec3> points, int dimensions, std::uint32_t first_entry,
          std::vector<PhotileTreeNode>& nodes)
      : points_(points), dimensions_(dimensions), first_entry_(first_entry), nodes_(nodes) {}

  std::uint32_t build(std::span<std::uint32_t> order, std::uint32_t offset, int depth) {
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    const std::uint32_t first = first_entry_ + offset;
    nodes_.push_back(
        {0, PHOTILE_TREE_LEAF, first, first + static_cast<std::uint32_t>(order.size())});
    if (order.size() <= leaf_size || depth == PHOTILE_TREE_DEPTH) return node;

    const PointBox box = box_of(points_, order);
    const glm::vec3 &low = box.low, &high = box.high;
    const int axis = widest_axis(box, dimensions_);
    if (!(high[axis] > low[axis])) return node;  // all in one point
    // The lower child takes what lies below the plane. Rounded down to `low`, the middle would
    // leave it empty.
    float split = low[axis] + 0.5f * (high[axis] - low[axis]);
    if (!(split > low[axis])) split = high[axis];
    const auto half = std::partition(order.begin(), order.end(),
                                     [&](std::uint32_t i) { return points_[i][axis] < split; });
    const auto lower = static_cast<std::size_t>(half - order.begin());
    build(order.first(lower), offset, depth + 1);
    const std::uint32_t upper =
        build(order.subspan(lower), offset + static_cast<std::uint32_t>(lower), depth + 1);
    nodes_[node] = {split, static_cast<std::uint32_t>(axis), upper, 0};
    return node;
  }

 private:
  std::span<const glm::vec3> points_;
  int dimensions_;
  std::uint32_t first_entry_;
  std::vector<PhotileTreeNode>& nodes_;
};

}  // namespace

std::uint32_t build_kdtree(std::span<const glm::vec3> points, std::span<std::uint32_t> order,
                           int dimensions, std::uint32_t first_entry,
                           std::vector<PhotileTreeNode>& nodes) {
  return Builder(points, dimensions, first_entry, nodes).build(order, 0, 0);
}

}  // namespace photile::maps
