// A hierarchy of boxes of eight over all photons (kernels/structures/wide_bvh.h), built on the
// host. Points are halved along the widest axis of their box, at the place that leaves all nodes
// and leaves but the last full.
#include "structures/wide_bvh.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "structures/halving.hpp"
#include "structures/structure.hpp"

namespace photile::structures {
namespace {

constexpr std::size_t wide = 8;  ///< children of a node, photons of a leaf

/// Leaves below a full child of a node over so many, which are more than one: a power of eight.
std::size_t leaves_of_child(std::size_t leaves) {
  std::size_t child = 1;
  while (child * wide < leaves) child *= wide;
  return child;
}

/// The number of nodes of the tree over so many leaves: none where one leaf is the child itself.
std::size_t count_nodes(std::size_t leaves) {
  if (leaves <= 1) return 0;
  const std::size_t child = leaves_of_child(leaves);
  const std::size_t full = (leaves - 1) / child;
  return 1 + full * count_nodes(child) + count_nodes(leaves - full * child);
}

std::size_t leaves_of(std::size_t points) { return (points + wide - 1) / wide; }

class WideBvhBuilder {
 public:
  WideBvhBuilder(std::span<const glm::vec3> points, std::vector<std::uint32_t>& words)
      : points_(points), words_(words) {}

  /// The node over the points from that of leaf `first_leaf` on; those below it follow it.
  void build(std::size_t node, std::size_t first_leaf, std::span<std::uint32_t> part) const {
    const std::size_t leaves = leaves_of(part.size()), child = leaves_of_child(leaves);
    const std::size_t children = (leaves + child - 1) / child;
    separate(part, children, child * wide);
    const auto build_child = [&](std::size_t i) {
      const std::size_t first = i * child * wide;
      const auto own = part.subspan(first, std::min(child * wide, part.size() - first));
      const std::size_t own_leaf = first_leaf + i * child;
      set_box(node, i, box_of(points_, own));
      std::uint32_t& what = word(node, 6 * wide + i);
      if (own.size() <= wide) {
        what = PHOTILE_WIDE_LEAF | static_cast<std::uint32_t>(own_leaf);
        return;
      }
      const std::size_t own_node = node + 1 + i * count_nodes(child);
      what = static_cast<std::uint32_t>(own_node);
      build(own_node, own_leaf, own);
    };
    for (std::size_t i = children; i < wide; ++i) set_box(node, i, {});
    if (part.size() < least_parallel_points) {
      for (std::size_t i = 0; i < children; ++i) build_child(i);
    } else {
      tbb::parallel_for(std::size_t{0}, children, build_child);
    }
  }

 private:
  /// Separates the points of `children` children, `points` each but for the last.
  void separate(std::span<std::uint32_t> part, std::size_t children, std::size_t points) const {
    if (children < 2) return;
    const std::size_t lower = children / 2;
    split_at(points_, part, lower * points, widest_axis(box_of(points_, part)));
    separate(part.first(lower * points), lower, points);
    separate(part.subspan(lower * points), children - lower, points);
  }

  std::uint32_t& word(std::size_t node, std::size_t place) const {
    return words_[node * PHOTILE_WIDE_NODE_WORDS + place];
  }

  void set_box(std::size_t node, std::size_t child, const PointBox& box) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto d = static_cast<glm::length_t>(axis);
      word(node, axis * wide + child) = std::bit_cast<std::uint32_t>(box.low[d]);
      word(node, (3 + axis) * wide + child) = std::bit_cast<std::uint32_t>(box.high[d]);
    }
  }

  std::span<const glm::vec3> points_;
  std::vector<std::uint32_t>& words_;
};

Index build_wide_bvh(const PhotonLists& lists) {
  std::vector<std::uint32_t> order = lists.members;
  const std::size_t nodes = std::max<std::size_t>(count_nodes(leaves_of(order.size())), 1);
  std::vector<std::uint32_t> words(nodes * PHOTILE_WIDE_NODE_WORDS);
  WideBvhBuilder(lists.photons.position, words).build(0, 0, order);
  return {.record_photon =
              lists.context.upload(std::span<const std::uint32_t>(order), "photon references"),
          .nodes = lists.context.upload(std::span<const std::uint32_t>(words), "nodes")};
}

const Registration wide_bvh({.name = "wide-bvh", .build = build_wide_bvh, .global = true});

}  // namespace
}  // namespace photile::structures
