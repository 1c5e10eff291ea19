// Photon passes of a rendering, and the light that each of them tells.
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

/// The photon estimate, as points ask for it.
struct PhotonLight {
  std::shared_ptr<light::LightAtPoints> of_points;
  /// The light at points that all processes ask for together; `own` where there is one process.
  std::shared_ptr<light::LightAtPoints> of_nodes;
  std::shared_ptr<const estimate::PhotonEstimate>
      estimate;  ///< null where maps are built when they are needed
};

/// The photons of one pass, and what follows from them.
struct PassPhotons {
  double radius = 0;  ///< of the first pass, metres
  PhotonLight all;
  PhotonLight at_ends;   ///< by fewer neighbours: of rays, where nodes gather; else null
  PhotonLight caustics;  ///< that came by mirrors and glass alone; null without any
  cache::LightMapParameters maps,
      ends;  ///< where light maps are read: of them, and of those at ray ends
  /// What such light maps held, if they were kept.
  std::optional<LightMapContents> contents = std::nullopt;
};

/// How far light maps have grown (docs/light-maps.md).
struct Growth {
  int parts = 1;  ///< in all rounds: nodes have this many times the rays of the settings
  cache::GatheredPoints points = {};  ///< at which rays gathered in the rounds before
};

/// The light of a scene by the photons of one pass: the plan decides here which source is queried
/// for which points. By photons alone it is the photon estimate; where light maps are read, a cache
/// whose nodes the estimate values, or rays, which read a coarser cache where they end.
class PassLight {
 public:
  /// References are kept. Errors: those of SurfaceCache.
  ///   growth   of light maps whose nodes gather
  PassLight(const RayScene& rays, const RenderPlan& plan, PassPhotons photons, Growth growth = {});

  /// Light maps of the same photons, after a further round of growing.
  ///   parts   as Growth has them
  void grow(int parts);

  /// All light at points: the end of the chain.
  light::LightAtPoints& light() {
    return cache_ ? static_cast<light::LightAtPoints&>(*cache_) : *photons_.all.of_points;
  }

  /// Null where light maps are not read.
  cache::SurfaceCache* cache() { return cache_ ? &*cache_ : nullptr; }
  const cache::SurfaceCache* cache() const { return cache_ ? &*cache_ : nullptr; }
  /// What values the nodes of the cache.
  cache::NodeSource& nodes() {
    return gathered_ ? static_cast<cache::NodeSource&>(*gathered_) : *by_photons_;
  }
  /// Where rays value nodes; else null.
  const cache::GatheredNodes* gathered() const { return gathered_ ? &*gathered_ : nullptr; }
  /// Takes the points at which rays gathered, for the light of further photons.
  cache::GatheredPoints take_points() { return gathered_->take_points(); }

  /// The order in which the light is found fastest: per oriented face, the map of a hit; empty
  /// where the order does not matter, and where processes share the maps: each has other maps, by
  /// whose numbers the hits of a pixel would be summed in another order on each.
  std::span<const std::uint32_t> map_of() const;
  /// Each device's part of all points so far; empty where that is not known.
  std::vector<double> fractions() const;

 private:
  void read_light_maps(Growth growth);

  const RayScene& rays_;
  const RenderPlan& plan_;
  const PassPhotons photons_;
  const std::vector<double> layer_powers_;
  const bool is_shared_;                           ///< with other processes
  std::optional<cache::IrradianceGather> gather_;  ///< where rays value nodes
  std::optional<cache::GatheredNodes> gathered_;
  std::optional<cache::ValuedBy> by_photons_;  ///< where photons value nodes
  std::optional<cache::SurfaceCache> cache_;
};

/// Traces the photons of one pass after another, and builds their maps. The first pass determines
/// the radius, the groups and the lit surface of all. Where light maps are read there is one pass,
/// and they may grow: further photons determine their own radius, groups and lit surface, and all
/// photons so far how close together nodes lie.
class PhotonPasses {
 public:
  /// References are kept.
  PhotonPasses(const RayScene& rays, std::span<Device> devices, const RenderPlan& plan,
               RenderCosts& costs);

  /// The next pass. What it returns refers to this object.
  ///   prepared   of the first pass: photons and groups in place of traced ones, or null; taken.
  ///              Where it has light maps of these settings, photon maps are built when an estimate
  ///              is first needed.
  ///   keep       is given those of the first pass, or null
  ///   parts      where light maps are read: the factor on the number of photons
  /// Errors: those of the stages.
  PassPhotons next(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress,
                   int parts = 1);

  /// The radius of the first pass, metres.
  double radius() const { return radius_; }

  /// In words: what nodes depend on beside the scene and the photons.
  std::string light_map_settings() const;

 private:
  struct Built {
    std::shared_ptr<const std::vector<PhotonMaps>> maps;  ///< the same on each device
    DensityKernel kernel;
    std::shared_ptr<const estimate::VisiblePhotons> seen;  ///< null: all photons count
  };
  struct Maps {
    Built photons;
    Built caustics;     ///< for rays that gather, where there are any
    PassPhotons facts;  ///< without their light
  };

  PassPhotons waiting(TracedPhotons& prepared, const KeepPhotons* keep);
  void check_map_memory() const;
  /// Photons of the pass, with all that is found before there are maps.
  PhotonTracerResult trace(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress);
  Maps trace_and_build(TracedPhotons* prepared, const KeepPhotons* keep, Progress& progress);
  Built build(Photons photons, const PhotonMapParameters& parameters, DensityKernel kernel,
              bool leaves_out_hidden, Progress& progress);
  std::shared_ptr<estimate::PhotonEstimate> estimate_of(const Built& built,
                                                        const EstimateParameters& parameters) const;
  /// By the k that was asked for.
  std::shared_ptr<estimate::PhotonEstimate> estimate_of(const Built& built) const;
  std::shared_ptr<estimate::PhotonEstimate> estimate_at_ends(const Built& built) const;
  /// The estimate as it is asked for where several processes have the maps.
  PhotonLight shared(std::shared_ptr<estimate::PhotonEstimate> estimate);
  /// What follows from the photons of the pass.
  PassPhotons facts(const Photons& photons);
  /// Where several processes share the rendering: sends photons to the owners of their maps.
  void move_to_owners(PhotonTracerResult& traced, Progress& progress);
  void count(const PhotonTracerResult& traced);
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
