// Photon paths from the lights.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/shard.hpp"

namespace photile {

/// How emitted photons are shared between the lights.
enum class PhotonQuota {
  balanced,  ///< half by power, half equally: dim lights stay clean when they are turned up
  power,     ///< by power: least noise at the scene's own powers
  equal      ///< the same number for each light
};

/// "balanced", "power", "equal".
std::string_view name_of(PhotonQuota quota);
inline constexpr std::array all_photon_quotas = {PhotonQuota::balanced, PhotonQuota::power,
                                                 PhotonQuota::equal};

struct PhotonTracerParameters {
  std::uint64_t emitted_photons = defaults::emitted_photons;  ///< over all lights
  PhotonQuota quota = PhotonQuota::balanced;
  std::uint64_t seed = defaults::seed;
  int max_path_length = defaults::max_path_length;  ///< surface interactions
  int roulette_start = defaults::roulette_start;    ///< bounces before roulette may end a path
  /// Whether photons that come straight from a lamp, or through panes of thin glass, are stored.
  bool store_direct = true;
  /// Whether photons that came by mirrors, or by glass that bends or reflects them, and nothing
  /// else are stored once more, on their own.
  bool keep_caustics = false;
  /// Paths of each light that earlier passes have traced: the first to be traced now. Empty: none.
  std::vector<std::uint64_t> paths_before = {};
  /// Of all paths, in the order light, path: what is traced. Flux and Photons::emitted_per_light
  /// are those of all paths, so that the photons of all shards together (merge_runs) are those of
  /// one process, bit for bit.
  Shard shard = {};
};

struct PhotonTracerResult {
  Photons photons;
  Photons caustics;  ///< of them, those that came by mirrors and glass alone; where they are kept
  std::vector<std::uint64_t> stored_per_light;
  /// Flux that left the scene, per unit of each light's power (luminance): for the energy balance.
  std::vector<double> escaped_flux_per_light;
  /// Flux absorbed at surfaces or ended by the bound on path length (luminance, unit power).
  std::vector<double> absorbed_flux_per_light;
  double seconds = 0;
};

/// Paths of each light, by the rules of `quota`; each light at least one. Sums to `total` or to the
/// number of lights, whichever is larger.
std::vector<std::uint64_t> photons_per_light(const Scene& scene, std::uint64_t total,
                                             PhotonQuota quota);

/// Traces photon paths with Embree and TBB and stores a photon at every hit on an opaque surface.
/// Each layer's lights together emit flux 1 (Scene::unit), shared as LightGroups::share says. The
/// result depends on the scene, the parameters and the seed only, bit for bit, whatever the number
/// of threads. Errors: UsageError for counts out of limits.hpp; Interrupted.
PhotonTracerResult trace_photons(const RayScene& scene, const PhotonTracerParameters& parameters,
                                 Progress& progress = Progress::none());

}  // namespace photile
