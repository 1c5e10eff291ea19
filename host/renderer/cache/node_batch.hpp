// Nodes that are valued together: their points, the nodes between which they lie and those around.
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <span>
#include <vector>

#include "cache/charts.hpp"
#include "photile/light_maps.hpp"
#include "photile/ray_scene.hpp"

namespace photile::cache {

/// Point i is that which owns node i, seen from straight above, matt.
///   glossy   whether hits of the scene have lobes
PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                        int levels, bool glossy);

struct NodePlaceHash {
  std::size_t operator()(const NodePlace& node) const;
};

/// Numbers of nodes.
using NodeIndex = tsl::robin_map<NodePlace, std::uint32_t, NodePlaceHash>;

/// Their points, the numbers of these, parents and links.
///   levels         of the light maps
///   glossy         whether hits of the scene have lobes
///   surroundings   places that values depend on
NodeBatch node_batch(const Scene& scene, Charts& charts, std::span<const NodePlace> nodes,
                     int levels, bool glossy, const NodeSource::Surroundings& surroundings);

/// The coarsest level of so many that has a node.
int level_of(const NodePlace& node, int levels);

/// The places between which nodes lie, and those between which these do, as far as a source does
/// not know them: by level, the coarsest first.
std::vector<std::vector<NodePlace>> unknown_parents(std::span<const NodePlace> nodes, int levels,
                                                    const NodeSource& source);

}  // namespace photile::cache
