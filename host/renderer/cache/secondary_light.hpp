// The light that rays find where they end: photon estimates at nodes on the surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cache/batch_sums.hpp"
#include "cache/node_visibility.hpp"
#include "light/light_at_points.hpp"
#include "photile/estimator.hpp"
#include "photile/light_maps.hpp"
#include "photile/ray_scene.hpp"
#include "trace/hemisphere_rays.hpp"

namespace photile::cache {

/// Photon estimates at some of the ends of rays.
struct SecondaryEstimates {
  PrimaryHits hits;
  LightTable estimates;  ///< a row for each hit
};

/// The hits of the rays of a run of points, and the light that counts there.
struct IndirectLight {
  trace::HemisphereRays rays;
  std::vector<std::uint32_t> own_of;   ///< of each hit, or none where light maps are read
  std::vector<BilinearWeights> nodes;  ///< of each hit that reads them
  std::vector<glm::vec3> weight;       ///< of each hit: of irradiance, or of radiance
  SecondaryEstimates own;              ///< of the run
};

/// Values nodes by the light at their points.
class ValuedBy : public NodeSource {
 public:
  /// The reference is kept. What a point gets from it does not depend on the points beside it.
  explicit ValuedBy(light::LightAtPoints& light) : light_(light) {}

  NodeValues value(const NodeBatch& batch, const Progress&) override {
    valued_ += batch.points.size();
    return {light_.at(batch.points, Progress::none()), {}, {}};
  }

  /// Nodes so far.
  std::uint64_t valued() const { return valued_; }

 private:
  light::LightAtPoints& light_;
  std::uint64_t valued_ = 0;
};

/// Irradiance where rays end, read from light maps that photon estimates value when a ray first
/// ends there.
class SecondaryLight {
 public:
  /// References are kept.
  ///   photons the source of light at hits that do not read light maps, and `of_nodes` that at
  ///   nodes: the same, unless several processes have the photons. What a point gets does not
  ///   depend
  ///             on the points beside it.
  ///   maps      of one level: a cell is known by its first node
  SecondaryLight(const RayScene& rays, light::LightAtPoints& photons,
                 light::LightAtPoints& of_nodes, const LightMapParameters& maps)
      : rays_(rays), photons_(photons), nodes_(of_nodes), parameters_(maps) {}

  /// Finds an estimate for each ray hit.
  /// Errors: as estimate::PhotonEstimate; Interrupted.
  IndirectLight query(trace::HemisphereRays rays, const Progress& progress);

  /// Adds what the rays of a point of the run see; each of its batches has this many rays.
  void add_point(const IndirectLight& light, std::size_t point, std::uint32_t batches,
                 std::uint32_t rays_per_batch, BatchSums& sums) const;

  /// The nodes around hits, and what nodes hold, in the form of estimates: node n is hit n. They
  /// are valued where they are not yet. Errors: as estimate::PhotonEstimate; Interrupted.
  std::vector<BilinearWeights> nodes_around(const PrimaryHits& hits, const Progress& progress);
  const LightTable& values() const { return maps_->maps.values(); }

  /// The processes that have the photon maps, and make the same calls; null where this one is
  /// alone.
  auto* processes() const { return parameters_.processes; }

  /// 1 for each oriented face of a slat: a chart narrower than `width` metres, with other surface
  /// in front of it at a smaller distance than its width. Found once, for the first width.
  std::span<const std::uint8_t> slats(double width);

  /// Metres, from node to node: as wide as the estimates that value them.
  double spacing() const { return parameters_.spacing; }

  /// Bytes of the light maps; `forget` empties them.
  std::uint64_t bytes() const;
  void forget() { maps_.reset(); }

  /// The costs of all calls so far.
  struct Costs {
    std::uint64_t rays = 0;  ///< traced; those along mirrors and glass included
    std::uint64_t hits = 0;
    std::uint64_t estimated = 0;  ///< points at which photons were searched
  };
  Costs costs() const;

 private:
  void classify(IndirectLight& light, std::vector<std::uint8_t>& has_own) const;
  void find_nodes(IndirectLight& light, std::vector<std::uint8_t>& has_own) const;
  void fill(const PrimaryHits& hits, const Progress& progress);
  bool find(std::uint32_t oriented_face, const glm::vec3& position,
            BilinearWeights& bilinear) const;
  bool is_open(const BilinearWeights& cell) const;
  SecondaryEstimates estimates_at(const trace::EyeRecord& ray_hits,
                                  std::span<const std::uint32_t> chosen, const Progress& progress);

  const RayScene& rays_;
  light::LightAtPoints& photons_;
  ValuedBy nodes_;
  /// The contrast of the nodes of a cell from which on their visibility is tested.
  static constexpr double any_contrast = 0;

  struct Maps {
    Maps(const RayScene& rays, const LightMapParameters& parameters)
        : maps(rays.scene(), parameters), visibility(rays, maps, any_contrast) {}
    LightMaps maps;
    NodeVisibility visibility;
    /// Whether the middle of a cell sees all nodes, by the first node; known once a hit asked.
    mutable std::vector<std::uint8_t> cells;
  };
  const LightMapParameters parameters_;
  std::optional<Maps> maps_;  ///< made when the first ray ends
  std::vector<std::uint8_t> slats_;
  Costs costs_;  ///< without nodes
};

}  // namespace photile::cache
