// The plan of a rendering: the settings, checked once, and all that follows from them. Every stage
// gets its parameters from here, and from nowhere else.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cache/irradiance_gather.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// Whether nodes of light maps gather light with these settings: where they have rays, unless nodes
/// are not used, or light samples from the hits replace a part of the light.
bool nodes_gather(const RenderParameters& asked);

/// How the light of matt surfaces is found.
enum class LightBy {
  photons,         ///< an estimate at each hit
  cached_photons,  ///< a cache, whose nodes have estimates
  cached_rays  ///< a cache, whose nodes gather by rays, which read a coarser cache where they end
};

/// What light is requested for: pictures, whose hits lie so close that many share nodes of light
/// maps, or scattered points, which read light maps only where the settings say so.
enum class HitsAsk { pictures, points };

class RenderPlan {
 public:
  /// Traces a few paths where the number of passes follows from the memory. Errors: those of
  /// `check` in render/setting.hpp and of automatic_passes.
  RenderPlan(const RenderParameters& asked, const RayScene& rays, HitsAsk hits, Progress& progress);

  /// The settings, completed by what follows from them: photon passes that fit in memory, light
  /// samples where rays gather, discs for naive maps. The radius is 0 where it follows from the
  /// photons.
  const RenderParameters& used() const { return used_; }

  LightBy light_by() const {
    if (used_.light_maps != LightMapMode::on) return LightBy::photons;
    return used_.light_map_rays > 0 ? LightBy::cached_rays : LightBy::cached_photons;
  }
  bool reads_light_maps() const { return light_by() != LightBy::photons; }
  /// Photons that came by mirrors and glass alone are then kept separately.
  bool gathers_at_nodes() const { return light_by() == LightBy::cached_rays; }

  int passes() const { return used_.passes; }
  /// Whether the photons of all passes may be kept at once: their number was given, and does not
  /// follow from the memory.
  bool may_keep_passes() const { return passes() == 1 || asked_passes_ > 0; }
  /// Whether photons that something hides from a point do not count there. Estimates at the hits of
  /// a picture's rays, the method of the paper, count all of them.
  bool leaves_out_hidden() const { return leaves_out_hidden_; }
  /// Whether shadow rays find the light of hot spots (trace/hot_spots.hpp), and photons leave it
  /// out: at points, and where rays gather at nodes.
  bool finds_hot_spots() const { return for_points_ || gathers_at_nodes(); }
  bool clips_areas() const { return used_.area == AreaMode::clipped; }

  /// The parameters of tracing in this pass, whose paths follow those of the passes before.
  ///   paths_before   of each light
  ///   parts          where light maps are read: the factor on the number of paths
  PhotonTracerParameters tracing(int pass, const std::vector<std::uint64_t>& paths_before,
                                 int parts = 1) const;

  /// The radius of the first pass, metres: as given, or by its photons. Errors: SettingError where
  /// no radius follows from them.
  double radius(const Photons& photons, Progress& progress) const;

  PhotonMapParameters maps(int pass, double first_radius) const;

  ///   surface   where areas are clipped, else null
  EstimateParameters estimate(int pass, DensityKernel kernel,
                              const std::shared_ptr<const SurfaceIndex>& surface) const;

  /// Of estimates where gathering rays end: they may be noisy, because a node adds up many of them,
  /// but they must not be blurred.
  int neighbours_at_ends() const;

  /// The parameters of light maps from these photons.
  ///   radius   of their maps, metres
  ///   powers   per layer
  cache::LightMapParameters light_maps(double radius, const Scene& scene, const Photons& photons,
                                       std::span<const double> powers) const;

  /// The parameters of light maps where gathering rays end.
  cache::LightMapParameters ends(double radius, const Scene& scene, const Photons& photons,
                                 std::span<const double> powers) const;
  /// At nodes of light maps.
  ///   radius   of the photon maps, metres
  ///   maps     of these nodes
  cache::IrradianceGatherParameters node_gathering(double radius,
                                                   const cache::LightMapParameters& maps) const;

  /// The samples of a pixel are divided between passes, with at least one in each: errors of
  /// neighbouring samples are similar for photons of one pass, and independent between passes.
  ///   passes   at least 1
  PrimaryHitParameters hits(const Film& film, int passes) const;

 private:
  /// The radius of an estimate there, where one with all neighbours has `radius`, metres.
  double reach_at_ends(double radius) const;

  RenderParameters used_;
  int asked_passes_;
  bool for_points_;
  bool leaves_out_hidden_ = false;
  double least_radius_;  ///< metres
  std::string scene_;    ///< for messages
};

}  // namespace photile
