// A left-balanced kd-tree over all photons, built on the host, searched by
// kernels/structures/kdtree_left_balanced.cl. Splits the widest axis of each node's points; of
// points at one coordinate those of smaller indices are lower.
#include <tbb/parallel_invoke.h>

#include <bit>

#include "structures/halving.hpp"
#include "structures/structure.hpp"

namespace photile::structures {
namespace {

/// Nodes of the lower subtree of a tree of `count` nodes whose levels are full but for the last,
/// which is filled from the left.
std::size_t lower_subtree(std::size_t count) {
  const std::size_t last_level = std::bit_floor(count);  // of the full tree
  return last_level / 2 - 1 + std::min(count - (last_level - 1), last_level / 2);
}

struct LeftBalancedBuilder {
  std::span<const glm::vec3> points;
  std::vector<std::uint32_t> order;  ///< of the nodes
  std::vector<std::uint8_t> axis;    ///< of each

  void build(std::span<std::uint32_t> part, std::size_t node) {
    if (part.empty()) return;
    const int widest = widest_axis(box_of(points, part));
    const std::size_t lower = part.size() > 1 ? lower_subtree(part.size()) : 0;
    split_at(points, part, lower, widest);
    order[node] = part[lower];
    axis[node] = static_cast<std::uint8_t>(widest);
    const auto build_lower = [&] { build(part.first(lower), 2 * node + 1); };
    const auto build_upper = [&] { build(part.subspan(lower + 1), 2 * node + 2); };
    if (part.size() < least_parallel_points) {
      build_lower();
      build_upper();
    } else {
      tbb::parallel_invoke(build_lower, build_upper);
    }
  }
};

Index build_left_balanced(const PhotonLists& lists) {
  const std::size_t count = lists.members.size();
  std::vector<std::uint32_t> part = lists.members;
  LeftBalancedBuilder builder{lists.photons.position, std::vector<std::uint32_t>(count),
                              std::vector<std::uint8_t>(count)};
  builder.build(part, 0);
  std::vector<std::uint32_t> words((count + 15) / 16);
  for (std::size_t i = 0; i < count; ++i) {
    words[i / 16] |= std::uint32_t{builder.axis[i]} << (2 * (i % 16));
  }
  return {.record_photon = lists.context.upload(std::span<const std::uint32_t>(builder.order),
                                                "photon references"),
          .nodes = lists.context.upload(std::span<const std::uint32_t>(words), "nodes")};
}

const Registration kdtree_left_balanced({.name = "kdtree-left-balanced",
                                         .build = build_left_balanced,
                                         .global = true});

}  // namespace
}  // namespace photile::structures
