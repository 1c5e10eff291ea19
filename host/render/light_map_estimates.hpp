// Estimates read from light maps where those serve a hit, and made at the hit where they do not.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "gather/end_light.hpp"
#include "light_maps/node_sight.hpp"
#include "photile/light_maps.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"
#include "render/map_estimators.hpp"
#include "render/reflection_noise.hpp"
#include "render/render_costs.hpp"

namespace photile {

/// Light maps for photons of this density: nodes lie as far apart as the photons that a typical
/// estimate takes, at the coarsest level, in steps of two.
///   neighbours   k
///   radius       of the photon maps, metres. One so small that estimates find no photon makes
///                nodes no closer than photons
///   detail       metres, > 0: spacing of the finest nodes, at most; 0 = an eighth of the coarsest
///   powers       per layer of the scene
LightMapParameters light_map_parameters(const Scene& scene, const Photons& photons, int neighbours,
                                        double radius, double angle_degrees, double detail,
                                        std::span<const double> powers);

/// What a photon pass needs where rays value nodes. Both null where photons do.
struct GatheringPass {
  NodeSource* nodes = nullptr;
  gathering::EndLight* ends = nullptr;  ///< read where photons alone serve
};

/// What the light of hits is read from.
struct HitReading {
  static constexpr int own_estimate = -1, ends = 0;
  std::vector<int> levels;        ///< of nodes; or `ends`, or `own_estimate`
  std::vector<NodeBlend> blends;  ///< of nodes or ends
};

class LightMapEstimates {
 public:
  /// References are kept.
  ///   photons   whose estimates of hits do not depend on the hits beside them
  LightMapEstimates(const RayScene& rays, const LightMapParameters& parameters,
                    MapEstimators& photons, const GatheringPass& gathering = {});

  /// A further photon pass: from now on nodes hold the mean of all. As the constructor.
  void add_pass(MapEstimators& photons, const GatheringPass& gathering);

  /// Of hits in any order. Those with a specular lobe or a normal map are estimated where they are.
  ///   pass         whose photons do that
  ///   by_photons   of each hit: whether photons alone may say its light (reflection_noise.hpp), so
  ///                that no nodes are gathered, or refined, for it; empty: of none
  /// Errors: as DeviceEstimators; Interrupted.
  Estimates estimate(const PrimaryHits& hits, const Progress& progress, std::size_t pass = 0,
                     std::span<const std::uint8_t> by_photons = {});

  /// The sided triangles whose photons `estimate` may look at for these hits, and some more.
  std::vector<std::uint32_t> looked_at(const PrimaryHits& hits);

  /// Standard errors of what `estimate` found at these hits, in the same form. Nodes around a hit
  /// are taken to err alike; where photons served, theirs is that of a density from k of them.
  ///   estimates   that were found
  ///   of_nodes    as GatheredNodes::errors
  ///   by_photons   as there
  Estimates errors(const PrimaryHits& hits, const Estimates& estimates, const Estimates& of_nodes,
                   std::span<const std::uint8_t> by_photons);

  /// Of the light that photons alone say.
  PhotonBlotches blotches() const;

  LightMaps& maps() { return maps_; }
  const LightMaps& maps() const { return maps_; }
  NodeSource& source() { return source_; }
  const light_maps::NodeSight& sight() const { return sight_; }

  /// Hits that were estimated where they are, so far.
  std::uint64_t hits_alone() const { return hits_alone_; }
  /// Of all light at hits read so far; zeros where photons value nodes.
  const ErrorSum& errors_read() const { return errors_read_; }
  TimeTaken fill_time() const { return fill_time_; }

 private:
  /// Nodes that photons value.
  class PhotonNodes : public PointSource {
   public:
    explicit PhotonNodes(MapEstimators& photons) : photons_(photons) {}
    Estimates irradiance(const PrimaryHits& nodes) override {
      return photons_.estimate_same(nodes);
    }

   private:
    MapEstimators& photons_;
  };

  /// The sources of all passes as one.
  class Passes : public NodeSource {
   public:
    void add(NodeSource& source) { (first_ ? further_.emplace_back() : first_) = &source; }
    Surroundings surroundings() const override { return first_->surroundings(); }
    NodeValues value(const NodeBatch& batch, const Progress& progress) override {
      return first_->value(batch, progress);
    }
    std::span<NodeSource* const> further() const override { return further_; }
    bool knows(std::uint64_t number) const override { return first_->knows(number); }
    std::uint64_t bytes() const override;
    void forget() override;

   private:
    NodeSource* first_ = nullptr;
    std::vector<NodeSource*> further_;
  };

  /// Whether the light of a hit can be read: it has no specular lobe and no normal map, which ask
  /// where light comes from.
  bool serves(const PrimaryHits& hits, std::size_t hit) const;

  /// Whether maps of photons are those of several processes, which make the same calls.
  bool shared() const { return photons_.front()->owners() != nullptr; }

  /// Values what the hits read, as a pass does.
  HitReading read(const PrimaryHits& hits, std::span<const std::uint8_t> by_photons,
                  const Progress& progress, std::size_t pass);
  void fill(const PrimaryHits& hits, std::span<const int> levels, const Progress& progress);
  void find_ends(const PrimaryHits& hits, const Progress& progress, std::size_t pass,
                 HitReading& reading);
  void find_nodes(const PrimaryHits& hits, HitReading& reading) const;

  /// Estimates of hits that follow each other.
  Estimates joined(std::vector<Estimates> parts) const;

  const Scene& scene_;
  const SceneNeeds needs_;
  const bool gathered_;      ///< rays value nodes, not photons
  const double neighbours_;  ///< of an estimate; maps of photons need not be there to tell it
  std::vector<MapEstimators*> photons_;     ///< of each pass
  std::vector<gathering::EndLight*> ends_;  ///< of each pass, where rays value nodes
  std::deque<PhotonNodes> photon_nodes_;    ///< where photons value nodes
  Passes source_;
  LightMaps maps_;
  light_maps::NodeSight sight_;
  std::uint64_t hits_alone_ = 0;
  ErrorSum errors_read_;
  TimeTaken fill_time_;
};

}  // namespace photile
