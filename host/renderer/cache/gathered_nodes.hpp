// Nodes of light maps whose light is gathered by rays, and the removal of its noise.
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cache/irradiance_filter.hpp"
#include "cache/irradiance_gather.hpp"
#include "cache/node_source.hpp"

namespace photile::cache {

struct GatheredNodesParameters {
  NodeRays coarse{64, 64};  ///< at the coarsest level
  NodeRays fine{25, 32};    ///< at all others
};

/// `coarse` rays at the coarsest level and a quarter of them at others, each with
/// defaults::light_samples_per_ray light samples; where a sun or a sky shines, more rays, and the
/// same number of light samples at all levels. Where the surface has room for only a few nodes,
/// each has more of both (defaults::few_nodes).
///   spacing   of the coarsest nodes, metres; 0 = whatever room there is
GatheredNodesParameters rays_of_nodes(const Scene& scene, int coarse, double spacing);

/// Points at which rays gathered, and what they found.
struct GatheredPoints {
  tsl::robin_map<std::uint64_t, std::uint32_t> row_of;  ///< by number
  std::vector<NodeRays> rays;                           ///< by row
  GatheredParts light;                                  ///< by row

  void append(std::span<const std::uint64_t> numbers, NodeRays of_each, GatheredParts found);
};

/// Gathers irradiance at nodes. The noise of rays is removed by rules that depend on the noise
/// itself (docs/method/filter.md): nodes of the coarsest level are averaged with those around them,
/// finer ones with those next to them, as far as differences may be noise and nothing stands
/// between the nodes. Direct light and light from other surfaces are treated separately.
class GatheredNodes : public NodeSource {
 public:
  /// References are kept. One LightMaps uses it.
  ///   rays     of a node, including those that it has in `former`
  ///   former   points of earlier light maps, with the same numbers. Those that are not requested
  ///            again are released with it
  GatheredNodes(IrradianceGather& gather, std::span<const double> layer_powers,
                const GatheredNodesParameters& rays, GatheredPoints former = {})
      : gather_(gather), layer_powers_(layer_powers), rays_(rays), former_(std::move(former)) {}

  Surroundings surroundings() const override;
  NodeValues value(const NodeBatch& batch, const Progress& progress) override;
  std::uint64_t bytes() const override;
  void forget() override;

  /// Takes the points at which rays gathered so far.
  GatheredPoints take_points() { return std::move(raw_); }

  /// Standard errors of all nodes filled so far: of each light at power 1, in its colour.
  ///   light   of these nodes, in the order in which they were filled
  LightTable errors(LightTable light) const;

 private:
  void gather_new(const NodeBatch& batch, std::span<const std::uint32_t> points, NodeRays rays,
                  const Progress& progress);
  PointLinks visible_links(const NodeBatch& batch, std::span<const std::uint32_t> rows) const;
  GatheredParts smoothed(const PointLinks& links, std::span<const std::uint32_t> rows,
                         std::span<const std::uint32_t> coarse) const;

  IrradianceGather& gather_;
  std::span<const double> layer_powers_;
  GatheredNodesParameters rays_;
  GatheredPoints former_;
  GatheredPoints raw_;
  std::vector<float> relative_errors_;  ///< of each light of each filled node
};

}  // namespace photile::cache
