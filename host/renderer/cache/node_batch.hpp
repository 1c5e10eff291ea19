// Nodes that are filled together: their points, and those around them.
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <span>
#include <vector>

#include "cache/charts.hpp"
#include "cache/node_source.hpp"
#include "photile/ray_scene.hpp"

namespace photile::cache {

/// Point i is the one that supports node i, seen from straight above, matt.
///   glossy   whether hits of the scene have lobes
PrimaryHits node_points(const Scene& scene, Charts& charts, std::span<const NodeCoordinates> nodes,
                        int levels, bool glossy);

/// Levels of light maps.
struct Levels {
  int all = 1;
  int skipped = 0;  ///< see LightMapParameters::skipped_levels
};

struct NodeCoordinatesHash {
  std::size_t operator()(const NodeCoordinates& node) const;
};

/// Numbers of nodes.
using NodeIndex = tsl::robin_map<NodeCoordinates, std::uint32_t, NodeCoordinatesHash>;

/// Their points, the numbers of these, and links.
///   glossy         whether hits of the scene have lobes
///   surroundings   positions that values depend on
NodeBatch node_batch(const Scene& scene, Charts& charts, std::span<const NodeCoordinates> nodes,
                     const Levels& levels, bool glossy,
                     const NodeSource::Surroundings& surroundings);

}  // namespace photile::cache
