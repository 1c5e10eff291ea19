// kd-trees over the photons of each map, in its plane (kdtree-2d) or in space (kdtree-3d), and one
// over all photons (kdtree-global), which is the classic photon map: built on the host, searched by
// kernels/structures/kdtree.cl, and those with "radix" by kdtree_radix.cl.
#include "structures/kdtree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "structures/halving.hpp"
#include "structures/structure.hpp"

namespace photile::structures {
namespace {

static_assert(sizeof(PhotileTreeNode) == 4 * 4, "PhotileTreeNode must have no padding");

/// Appends the nodes of a tree over points[order[i]] to `nodes` and brings `order` into the order
/// of the leaves. Leaves hold up to leaf_size points (more where points coincide or the depth is
/// used up) and refer to records first_record + position in `order`. Splits the longest side of the
/// points' box at its middle, slid to the nearest point where one side would be empty
/// (Maneewongvatana and Mount, "It's okay to be skinny, if your friends are fat", 1999).
struct TreeBuilder {
  std::span<const glm::vec3> points;
  int dimensions;  ///< 2 ignores z
  std::size_t leaf_size;
  std::uint32_t first_record;
  std::vector<PhotileTreeNode>& nodes;

  /// Returns the index of the root.
  std::uint32_t build(std::span<std::uint32_t> order, std::uint32_t offset, int depth) {
    const auto node = static_cast<std::uint32_t>(nodes.size());
    const std::uint32_t first = first_record + offset;
    nodes.push_back(
        {0, PHOTILE_TREE_LEAF, first, first + static_cast<std::uint32_t>(order.size())});
    if (order.size() <= leaf_size || depth == PHOTILE_TREE_DEPTH) return node;

    const PointBox box = box_of(points, order);
    const glm::vec3 &low = box.low, &high = box.high;
    const int axis = widest_axis(box, dimensions);
    if (!(high[axis] > low[axis])) return node;  // all in one point
    // The lower child takes what lies below the plane. Rounded down to `low`, the middle would
    // leave it empty.
    float split = low[axis] + 0.5f * (high[axis] - low[axis]);
    if (!(split > low[axis])) split = high[axis];
    const auto half = std::partition(order.begin(), order.end(),
                                     [&](std::uint32_t i) { return points[i][axis] < split; });
    const auto lower = static_cast<std::size_t>(half - order.begin());
    build(order.first(lower), offset, depth + 1);
    const std::uint32_t upper =
        build(order.subspan(lower), offset + static_cast<std::uint32_t>(lower), depth + 1);
    nodes[node] = {split, static_cast<std::uint32_t>(axis), upper, 0};
    return node;
  }
};

/// Coordinates in the plane of a grid, metres.
glm::vec2 project(const glm::vec3& p, const PhotileGrid& grid) {
  const glm::vec3 local = p - glm::vec3(grid.origin_x, grid.origin_y, grid.origin_z);
  return {glm::dot(local, glm::vec3(grid.u_axis_x, grid.u_axis_y, grid.u_axis_z)),
          glm::dot(local, glm::vec3(grid.v_axis_x, grid.v_axis_y, grid.v_axis_z))};
}

/// The tree of one list, whose part of `records` it brings into the order of its leaves.
std::vector<PhotileTreeNode> tree_of(const PhotonLists& lists, std::size_t list, int dimensions,
                                     std::size_t leaf_size, std::vector<std::uint32_t>& records) {
  const auto members = lists.of(list);
  std::vector<glm::vec3> points(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const glm::vec3& position = lists.photons.position[members[i]];
    points[i] = dimensions == 2 ? glm::vec3(project(position, lists.planes[list]), 0.0f) : position;
  }
  std::vector<std::uint32_t> order(members.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<PhotileTreeNode> nodes;
  TreeBuilder{points, dimensions, leaf_size, lists.first[list], nodes}.build(order, 0, 0);
  for (std::size_t i = 0; i < order.size(); ++i) records[lists.first[list] + i] = members[order[i]];
  return nodes;
}

template <int dimensions, std::size_t leaf_size = 8>
Index build_trees(const PhotonLists& lists) {
  std::vector<std::uint32_t> records(lists.members.size());
  std::vector<std::vector<PhotileTreeNode>> trees(lists.size());
  tbb::parallel_for(std::size_t{0}, lists.size(), [&](std::size_t list) {
    if (!lists.of(list).empty()) trees[list] = tree_of(lists, list, dimensions, leaf_size, records);
  });
  std::vector<std::uint32_t> root(lists.size(), none);
  std::vector<PhotileTreeNode> nodes;
  for (std::size_t list = 0; list < lists.size(); ++list) {
    if (trees[list].empty()) continue;
    root[list] = static_cast<std::uint32_t>(nodes.size());
    for (PhotileTreeNode node : trees[list]) {
      if (node.axis != PHOTILE_TREE_LEAF) node.first += root[list];
      nodes.push_back(node);
    }
  }
  constexpr std::size_t words = sizeof(PhotileTreeNode) / sizeof(std::uint32_t);
  device::Context& context = lists.context;
  return {
      .record_photon = context.upload(std::span<const std::uint32_t>(records), "photon references"),
      .root = context.upload(std::span<const std::uint32_t>(root), "tree roots"),
      .nodes = context.upload(
          std::span(reinterpret_cast<const std::uint32_t*>(nodes.data()), words * nodes.size()),
          "tree nodes")};
}

const Registration kdtree_2d(
    {.name = "kdtree-2d", .build = build_trees<2>, .kernel = "kdtree", .symbol = "TREE_2D"});
const Registration kdtree_3d({.name = "kdtree-3d", .build = build_trees<3>, .kernel = "kdtree"});
const Registration kdtree_global(
    {.name = "kdtree-global", .build = build_trees<3>, .global = true, .kernel = "kdtree"});

/// The same tree as kdtree-2d, with leaves of so many and the selection of the grid.
template <std::size_t leaf_size>
Structure tree_by_radix() {
  constexpr std::uint32_t ranges = 128;
  return {.name = "kdtree-2d-radix-" + std::to_string(leaf_size),
          .build = build_trees<2, leaf_size>,
          .kernel = "kdtree_radix",
          .symbol = "LEAF_SIZE",
          .symbol_value = leaf_size,
          .words_per_item = 2 * ranges};
}

const Registration radix_32(tree_by_radix<32>());
const Registration radix_64(tree_by_radix<64>());
const Registration radix_128(tree_by_radix<128>());

}  // namespace
}  // namespace photile::structures
