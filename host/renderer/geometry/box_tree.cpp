#include "geometry/box_tree.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <numeric>

namespace photile::geometry {
namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr std::uint32_t boxes_per_task = 4096;

}  // namespace

Box triangle_box(const Scene& scene, std::uint32_t triangle) {
  Box box;
  for (const glm::vec3& corner : scene.corners(triangle)) box.extend(corner);
  return box;
}

std::vector<Box> triangle_boxes(const Scene& scene) {
  std::vector<Box> boxes(scene.triangle_count());
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t t) {
    boxes[t] = triangle_box(scene, static_cast<std::uint32_t>(t));
  });
  return boxes;
}

class BoxTree::Builder {
 public:
  Builder(std::span<const Box> boxes, BoxTree& tree) : boxes_(boxes), tree_(tree) {}

  std::uint32_t used_nodes() const { return used_nodes_; }

  /// Fills a node with the boxes [first, last) of the order.
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t last) {
    Box all, centres;
    for (std::uint32_t i = first; i < last; ++i) {
      const Box& box = boxes_[tree_.order_[i]];
      all.extend(box);
      centres.extend(box.lower + box.upper);
    }
    if (last - first <= leaf_size) {
      tree_.nodes_[node] = {all, first, last - first};
      return;
    }
    const int axis = centres.longest_axis();
    const std::uint32_t middle = first + (last - first) / 2;
    const auto order = tree_.order_.begin();
    std::nth_element(order + first, order + middle, order + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return boxes_[a].lower[axis] + boxes_[a].upper[axis] <
                              boxes_[b].lower[axis] + boxes_[b].upper[axis];
                     });
    const std::uint32_t children = used_nodes_.fetch_add(2);
    tree_.nodes_[node] = {all, children, 0};
    const auto build_first = [&] { build(children, first, middle); };
    const auto build_second = [&] { build(children + 1, middle, last); };
    if (last - first > boxes_per_task) {
      tbb::parallel_invoke(build_first, build_second);
    } else {
      build_first();
      build_second();
    }
  }

 private:
  std::span<const Box> boxes_;
  BoxTree& tree_;
  std::atomic<std::uint32_t> used_nodes_{1};
};

BoxTree::BoxTree(std::span<const Box> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.resize(boxes.size());  // enough: leaves hold two boxes or more, unless there is only one
  Builder builder(boxes, *this);
  builder.build(0, 0, static_cast<std::uint32_t>(boxes.size()));
  nodes_.resize(builder.used_nodes());
}

}  // namespace photile::geometry
