#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "maps/grid_cells.hpp"
#include "maps/other_structures.hpp"
#include "structures/global_structures.hpp"
#include "structures/kdtree.hpp"

namespace photile::maps {
namespace {

/// The tree of one map; replaces `entries` (photon indices) by the order of its leaves.
void build_tree(MapStructure structure, const Photons& photons, const PhotileGrid& grid,
                std::span<std::uint32_t> entries, std::uint32_t first_entry,
                std::vector<PhotileTreeNode>& nodes) {
  const bool planar = structure == MapStructure::kdtree_2d;
  std::sort(entries.begin(), entries.end());  // work-items scattered them in any order
  std::vector<glm::vec3> points(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const glm::vec3& position = photons.position[entries[i]];
    points[i] = planar ? glm::vec3(project(position, grid), 0.0f) : position;
  }
  std::vector<std::uint32_t> order(entries.size());
  std::iota(order.begin(), order.end(), 0u);
  build_kdtree(points, order, planar ? 2 : 3, first_entry, nodes);
  std::vector<std::uint32_t> sorted(entries.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = entries[order[i]];
  std::copy(sorted.begin(), sorted.end(), entries.begin());
}

void set_nodes(device::Context& context, const std::vector<PhotileTreeNode>& nodes, MapPage& page) {
  page.node_count = static_cast<std::uint32_t>(nodes.size());
  constexpr std::size_t words = sizeof(PhotileTreeNode) / sizeof(std::uint32_t);
  page.nodes = context.upload(
      std::span(reinterpret_cast<const std::uint32_t*>(nodes.data()), words * nodes.size()),
      "tree nodes");
}

}  // namespace

bool is_tree(MapStructure structure) {
  return structure == MapStructure::kdtree_2d || structure == MapStructure::kdtree_3d;
}

void build_trees(device::Context& context, MapStructure structure, const Photons& photons,
                 std::span<const std::uint32_t> map_count, MapPage& page) {
  const std::uint32_t maps = page.last_map - page.first_map;
  std::vector<PhotileGrid> grids(maps);
  context.read(page.grids, std::span(grids));
  std::vector<std::uint32_t> entries(page.entry_count);
  context.read(page.entry_photon, std::span(entries));
  const auto counts = map_count.subspan(page.first_map, maps);
  std::vector<std::uint32_t> first_entry(maps);
  std::exclusive_scan(counts.begin(), counts.end(), first_entry.begin(), 0u);

  std::vector<std::vector<PhotileTreeNode>> trees(maps);
  tbb::parallel_for(0u, maps, [&](std::uint32_t map) {
    if (counts[map] == 0) return;
    build_tree(structure, photons, grids[map],
               std::span(entries).subspan(first_entry[map], counts[map]), first_entry[map],
               trees[map]);
  });

  std::vector<std::uint32_t> root(maps, none);
  std::vector<PhotileTreeNode> nodes;
  for (std::uint32_t map = 0; map < maps; ++map) {
    if (trees[map].empty()) continue;
    root[map] = static_cast<std::uint32_t>(nodes.size());
    for (PhotileTreeNode node : trees[map]) {
      if (node.axis != PHOTILE_TREE_LEAF) node.first += root[map];
      nodes.push_back(node);
    }
  }
  context.write(page.entry_photon, std::span<const std::uint32_t>(entries));
  page.tree_root = context.upload(std::span<const std::uint32_t>(root), "tree roots");
  set_nodes(context, nodes, page);
}

void build_global_tree(device::Context& context, const Photons& photons, MapPage& page) {
  std::vector<std::uint32_t> order(photons.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<PhotileTreeNode> nodes;
  build_kdtree(photons.position, order, 3, 0, nodes);
  const std::vector<std::uint32_t> root(page.last_map - page.first_map, 0u);
  page.entry_photon = context.upload(std::span<const std::uint32_t>(order), "photon references");
  page.tree_root = context.upload(std::span<const std::uint32_t>(root), "tree roots");
  set_nodes(context, nodes, page);
}

}  // namespace photile::maps
