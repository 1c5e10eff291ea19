// Photon paths from the lights, and the photons that they store: a structure of arrays, ready for
// the device.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string_view>
#include <vector>

#include "photile/communicator.hpp"
#include "photile/defaults.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// Data of all photons together, where several processes hold them.
struct PhotonsOfAll {
  Communicator* processes = nullptr;  ///< that hold them
  std::uint64_t count = 0;
  std::vector<std::uint32_t> landed;  ///< per oriented face: photons there
  /// Positions of groups::max_subsample photons, spread evenly, or of all where there are fewer.
  std::vector<glm::vec3> spread;
  /// Positions of every n-th photon, by which groups::PhotonSample judges patches, and their
  /// oriented faces.
  std::vector<glm::vec3> sample;
  std::vector<std::uint32_t> sample_triangle;
  /// Per oriented face: 1 where its photons are all here, and no other process answers for them.
  /// Empty before photons have been sent to the processes that hold their maps.
  std::vector<std::uint8_t> own;
};

/// Photons in the order of their oriented faces (stable: within one in the order light, path,
/// bounce). Which arrays are filled depends on SceneNeeds.
struct Photons {
  std::vector<glm::vec3> position;  ///< metres, on the triangle
  /// Flux of the photon where the lights of its layer together emit 1 lm or 1 W, linear RGB. Summed
  /// over the photons that a layer's lights emitted, before the first hit, the luminance is 1.
  std::vector<glm::vec3> flux;
  std::vector<glm::vec3> incoming;   ///< unit, towards where it came from; empty unless glossy
  std::vector<std::uint16_t> light;  ///< layer, into LightGroups::groups; empty for a single layer
  std::vector<std::uint32_t> oriented_face;

  /// Photons of oriented face s are [first_of[s], first_of[s + 1]). Size 2 * triangles + 1.
  std::vector<std::uint32_t> first_of;
  std::vector<std::uint64_t> emitted_per_light;  ///< paths started

  /// Data of all photons where these are the part that one process holds; null: these are all.
  std::shared_ptr<const PhotonsOfAll> of_all;

  std::size_t size() const { return position.size(); }
  /// The number of photons of all processes.
  std::uint64_t total() const { return of_all ? of_all->count : size(); }
  std::uint64_t bytes() const;
};

/// Photons in any order (`first_of` ignored) brought into the order of their oriented faces by a
/// stable counting sort; fills `first_of`.
Photons sort_by_oriented_face(Photons photons, std::size_t oriented_face_count);

/// The photons of several runs of paths as if one process had traced them: those of each oriented
/// face in the order of the runs. All runs have the same arrays.
///   runs   in the order light, path; consumed, so that only one array is in memory twice at a time
Photons merge_runs(std::vector<Photons> runs);

/// How emitted photons are divided between the lights.
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
  /// Whether photons that come directly from a light, or through panes of thin glass, are stored.
  bool store_direct = true;
  /// Whether photons that come only by mirrors, or by glass that bends or reflects them, are also
  /// stored separately, from additional paths aimed at these surfaces.
  bool keep_caustics = false;
  /// Paths of each light that earlier passes have traced: the first to be traced now. Empty: none.
  std::vector<std::uint64_t> paths_before = {};
  /// The part of all paths, in the order light, path, that is traced. Flux and
  /// Photons::emitted_per_light are those of all paths, so that the photons of all shards together
  /// (merge_runs) are those of one process, bit for bit.
  Shard shard = {};
};

struct PhotonTracerResult {
  Photons photons;
  Photons caustics;  ///< that came by mirrors and glass alone, from their own paths; if kept
  std::vector<std::uint64_t> stored_per_light;
  /// Flux that left the scene, per unit of each light's power (luminance): for the energy balance.
  std::vector<double> escaped_flux_per_light;
  /// Flux absorbed at surfaces or ended by the bound on path length (luminance, unit power).
  std::vector<double> absorbed_flux_per_light;
  double seconds = 0;
};

/// Paths of each light, divided by `quota`; each light has at least one. Sums to `total` or to the
/// number of lights, whichever is larger.
std::vector<std::uint64_t> photons_per_light(const Scene& scene, std::uint64_t total,
                                             PhotonQuota quota);

/// Traces photon paths with Embree and TBB and stores a photon at every hit on an opaque surface.
/// Each layer's lights together emit flux 1 (Scene::unit), divided among them by
/// LightGroups::fraction. The result depends on the scene, the parameters and the seed only, bit
/// for bit, whatever the number of threads. Errors: UsageError for counts out of limits.hpp;
/// Interrupted.
PhotonTracerResult trace_photons(const RayScene& scene, const PhotonTracerParameters& parameters,
                                 Progress& progress = Progress::none());

}  // namespace photile
