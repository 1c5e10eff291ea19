// The whole method in one call: trace, group, build, estimate.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/estimate_tuning.hpp"
#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/primary_hits.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"

namespace photile {

struct RenderParameters {
  PhotonTracerParameters photons;
  MapMode maps = MapMode::automatic;
  double radius = 0;  ///< metres; 0 = automatic_radius
  double angle_degrees = defaults::group_angle_degrees;
  int neighbours = defaults::neighbours;
  /// > 0: each hit has a number of neighbours of its own, from about this to `neighbours`: as many
  /// as its estimate can have before bias shows above the noise. 0 = all have `neighbours`.
  int least_neighbours = 0;
  float photons_per_cell = defaults::photons_per_cell;
  MapStructure structure = MapStructure::uniform_grid;
  /// How uniform grids are queried; none = shipped_tuning of the device. Its photons_per_cell does
  /// not count, the one above does.
  std::optional<EstimateTuning> tuning = std::nullopt;
  /// What the density divides by. Naive maps take the disc in any case.
  AreaMode area = AreaMode::clipped;
  AreaMode area_used() const { return maps == MapMode::naive ? AreaMode::disc : area; }
  DensityKernel kernel = DensityKernel::constant;  ///< what each photon counts
  PrimaryHitParameters film;
  /// > 0: light from other surfaces is gathered by so many rays from each hit, which look photons
  /// up where they end; at the hit itself only caustics are (docs/final-gathering.md). 0 = all
  /// light is looked up at the hit.
  int final_gather_rays = 0;
  /// Final gathering has no photons for direct light.
  int direct_rays_used() const {
    return final_gather_rays > 0 && film.direct_rays == 0 ? defaults::direct_rays
                                                          : film.direct_rays;
  }
  /// Without those that film.direct_rays replaces; where rays gather, those see direct light, too.
  PhotonTracerParameters photons_used() const {
    PhotonTracerParameters used = photons;
    used.store_direct = film.direct_rays == 0 || final_gather_rays > 0;
    used.keep_caustics = final_gather_rays > 0;
    return used;
  }
  /// Photon passes, see docs/memory.md: each traces its share of the photons, and the picture is
  /// their mean. 0 = as many as the host's memory asks for.
  int passes = 0;
};

struct RenderResult {
  LightLayers layers;
  RunStatistics statistics;
  double radius = 0;                 ///< the one used, metres; of the first pass
  std::uint64_t stored_photons = 0;  ///< over all passes
  int passes = 1;
  int samples_per_pixel = 1;          ///< over all passes: those asked for, or one more for a pass
  std::vector<double> device_shares;  ///< each device's part of the hits, in [0, 1]
};

/// Renders the picture of `camera`, one layer per light, on one device or several at once. Each
/// device holds all maps, and estimates as many hits as its throughput so far allows. On devices of
/// one kind the picture is that of one of them, bit for bit.
/// Errors: those of the stages; the first device that fails ends the work of all.
RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress = Progress::none());
RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress = Progress::none());

}  // namespace photile
