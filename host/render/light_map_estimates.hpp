// Estimates read from light maps where those serve a hit, and made at the hit where they do not.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light_maps/node_sight.hpp"
#include "photile/light_maps.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"
#include "render/map_estimators.hpp"

namespace photile {

/// Light maps for photons of this density: nodes lie as far apart as the photons that a typical
/// estimate takes, at the coarsest level, in steps of two.
///   neighbours   k
///   radius       of the photon maps, metres
///   detail       metres, > 0: spacing of the finest nodes, at most; 0 = an eighth of the coarsest
///   powers       per layer of the scene
LightMapParameters light_map_parameters(const Photons& photons, int neighbours, double radius,
                                        double angle_degrees, double detail,
                                        std::span<const double> powers);

class LightMapEstimates : private PointSource {
 public:
  /// References are kept.
  ///   photons   whose estimates of hits do not depend on the hits beside them
  ///   nodes     what values nodes; null: photons do
  LightMapEstimates(const RayScene& rays, const LightMapParameters& parameters,
                    MapEstimators& photons, NodeSource* nodes = nullptr);

  /// Of hits in any order. Those with a specular lobe or a normal map are estimated where they are.
  /// Errors: as DeviceEstimators; Interrupted.
  Estimates estimate(const PrimaryHits& hits, const Progress& progress);

  LightMaps& maps() { return maps_; }
  const LightMaps& maps() const { return maps_; }
  NodeSource& source() { return *source_; }

  /// Hits that were estimated where they are, so far.
  std::uint64_t hits_alone() const { return hits_alone_; }
  /// Root mean square, over all hits read so far, of the relative standard error of all light; 0
  /// where photons value nodes.
  double error() const;
  TimeTaken fill_time() const { return fill_time_; }

 private:
  Estimates irradiance(const PrimaryHits& nodes) override { return photons_.estimate(nodes); }

  /// Whether the light of a hit can be read: it has no specular lobe and no normal map, which ask
  /// where light comes from.
  bool serves(const PrimaryHits& hits, std::size_t hit) const;

  /// The nodes around hits that are not `alone`. Makes those alone that none of their nodes sees.
  std::vector<NodeBlend> blends_of(const PrimaryHits& hits, std::vector<std::uint8_t>& alone) const;

  const Scene& scene_;
  const SceneNeeds needs_;
  MapEstimators& photons_;
  NodeSource* source_;
  LightMaps maps_;
  light_maps::NodeSight sight_;
  std::uint64_t hits_alone_ = 0, hits_read_ = 0;
  double squared_errors_ = 0;  ///< relative, of hits read
  TimeTaken fill_time_;
};

}  // namespace photile
