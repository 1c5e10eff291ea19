#include <tbb/parallel_invoke.h>

#include <bit>
#include <numeric>

#include "structures/global_structures.hpp"
#include "structures/widest_axis.hpp"

namespace photile::maps {
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

}  // namespace

OrderedPoints build_left_balanced(std::span<const glm::vec3> points) {
  std::vector<std::uint32_t> part(points.size());
  std::iota(part.begin(), part.end(), 0u);
  LeftBalancedBuilder builder{points, std::vector<std::uint32_t>(points.size()),
                              std::vector<std::uint8_t>(points.size())};
  builder.build(part, 0);
  OrderedPoints built;
  built.order = std::move(builder.order);
  built.words.resize((points.size() + 15) / 16);
  for (std::size_t i = 0; i < points.size(); ++i) {
    built.words[i / 16] |= std::uint32_t{builder.axis[i]} << (2 * (i % 16));
  }
  built.nodes = static_cast<std::uint32_t>(points.size());
  return built;
}

}  // namespace photile::maps
