// Photon passes of a rendering, and the light that each of them gives.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cache/gathered_nodes.hpp"
#include "cache/irradiance_gather.hpp"
#include "cache/surface_cache.hpp"
#include "estimate/photon_estimate.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/surface_index.hpp"
#include "render/kernel_preparation.hpp"
#include "render/render_costs.hpp"
#include "render/render_plan.hpp"
#include "render/shared_photons.hpp"

namespace photile {

/// The photons of one pass, and the data derived from them.
struct PassPhotons {
  using Light = std::shared_ptr<light::LightAtPoints>;

  double radius = 0;  ///< of the first pass, metres
  Light all;
  Light at_ends;   ///< by fewer neighbours: for ray hits, where nodes gather; else null
  Light caustics;  ///< that came by mirrors and glass alone; null without any
  /// The estimate for most points; null where maps are built only when they are needed.
  std::shared_ptr<const estimate::PhotonEstimate> estimate;
  /// Where light maps are read: of them, and of those at ray ends.
  cache::LightMapParameters maps, ends;
  /// The contents of such light maps, if they were kept.
  std::optional<LightMapContents> contents = std::nullopt;
};

/// The light of a scene by the photons of one pass: a chain of sources, according to the plan.
class PassLight {
 public:
  /// References are kept. Errors: those of SurfaceCache.
  PassLight(const RayScene& rays, const RenderPlan& plan, PassPhotons photons, int parts = 1,
            cache::GatheredPoints points = {});

  /// Makes the chain.
  ///   parts    where nodes gather: they have this many times the rays of the settings
  ///   points   at which rays gathered before
  void make_light(int parts, cache::GatheredPoints points);

  /// The light at hits, and its standard errors where these are requested; else they are empty.
  cache::LightAndErrors at(const PrimaryHits& hits, bool with_errors, const Progress& progress) {
    if (!cache_) return {photons_.all->at(hits, progress), {}};
    if (with_errors) return cache_->with_errors(hits, *gathered_, progress);
    return {cache_->at(hits, progress), {}};
  }

  /// Null where light maps are not read.
  cache::SurfaceCache* cache() { return cache_ ? &*cache_ : nullptr; }
  const cache::SurfaceCache* cache() const { return cache_ ? &*cache_ : nullptr; }
  /// Where rays fill nodes; else null.
  const cache::GatheredNodes* gathered() const { return gathered_ ? &*gathered_ : nullptr; }
  /// Takes out the points at which rays gathered, for the light of further photons.
  cache::GatheredPoints take_points() { return gathered_->take_points(); }

  /// The order in which a pixel's hits are summed: per oriented face, the map of a hit; empty where
  /// it is the order of the faces: where light maps are read, and where processes share the photon
  /// maps, because each process has different maps.
  std::span<const std::uint32_t> map_of() const;
  /// Each device's part of all points so far; empty where that is not known.
  std::vector<double> fractions() const;

 private:
  const RayScene& rays_;
  const RenderPlan& plan_;
  const PassPhotons photons_;
  const std::vector<double> layer_powers_;
  std::optional<cache::IrradianceGather> gather_;  ///< where rays fill nodes
  std::optional<cache::GatheredNodes> gathered_;
  std::optional<cache::ValuedBy> by_photons_;  ///< where photons fill nodes
  std::optional<cache::SurfaceCache> cache_;
};

/// Traces the photons of one pass after another, and builds their maps. The first pass determines
/// the radius, the groups and the lit surface of all. Where light maps are read there is one pass,
/// and further photons may follow: they determine their own radius, groups and lit surface, and all
/// photons so far how close together nodes lie.
class PhotonPasses {
 public:
  /// References are kept.
  PhotonPasses(const RayScene& rays, std::span<Device> devices, const RenderPlan& plan,
               RenderCosts& costs);

  /// The next pass. What it returns refers to this object.
  ///   prepared   of the first pass: photons and groups instead of traced ones, or null;
  ///              consumed. Where it has light maps of these settings, photon maps are built
  ///              when an estimate is first needed.
  ///   keep       is given those of the first pass, or null
  ///   parts      where light maps are read: the factor on the number of photons
  /// Errors: those of the stages.
  PassPhotons next(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress,
                   int parts = 1);

  /// The radius of the first pass, metres.
  double radius() const { return radius_; }

  /// In words: what nodes depend on besides the scene and the photons.
  std::string light_map_settings() const;

 private:
  using Parts = estimate::PhotonEstimate::Parts;

  PassPhotons build(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress);
  PassPhotons build_later(TracedPhotons& prepared, const KeepPhotons* keep);
  void check_map_memory() const;
  /// The photons of the pass, with all data found before the maps are built.
  PhotonTracerResult trace(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress);
  Parts build_maps(Photons photons, DensityKernel kernel, bool leaves_out_hidden,
                   Progress& progress);
  /// The estimate as it is requested where several processes have the maps.
  PassPhotons::Light shared(std::shared_ptr<estimate::PhotonEstimate> estimate);
  /// Derives the data of the pass from its photons.
  PassPhotons facts(const Photons& photons);
  /// Where several processes share the rendering: sends photons to the owners of their maps.
  void move_to_owners(PhotonTracerResult& traced, Progress& progress);
  void find_groups(const Photons& photons, TracedPhotons* prepared, Progress& progress);
  void find_surface(const Photons& photons);

  const RayScene& rays_;
  const Scene& scene_;
  std::span<Device> devices_;
  const RenderPlan& plan_;
  RenderCosts& costs_;
  const std::vector<double> layer_powers_;
  std::optional<KernelPreparation> kernels_;             ///< begun when photons are first traced
  int pass_ = 0;                                         ///< the next; 0 where light maps are read
  int parts_ = 0, all_parts_ = 0;                        ///< of the latest photons, and of all
  std::optional<cache::LightMapParameters> first_maps_;  ///< of the first photons
  std::vector<std::uint64_t> paths_before_;              ///< per light
  double radius_ = 0;                                    ///< of the first pass, metres
  NeighbourGroups groups_;
  std::shared_ptr<const SurfaceIndex> surface_;  ///< where areas are clipped
  std::shared_ptr<const MapOwners> owners_;      ///< where several processes share the rendering
};

}  // namespace photile
