#include "trace/photon_tracer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/value_range.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "photile/photons.hpp"
#include "photile/statistics.hpp"
#include "trace/hot_spots.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"
#include "trace/scatter.hpp"
#include "trace/surface.hpp"
#include "trace/weight_windows.hpp"

namespace photile::trace {

namespace {

double luminance_of(const glm::vec3& flux) { return luminance(glm::dvec3(flux)); }

/// One photon of the density that is estimated at this point.
void store(const PathSetup& setup, const SurfacePoint& point, const glm::vec3& direction,
           const glm::vec3& flux, PhotonRun& run) {
  run.position.push_back(point.position);
  run.flux.push_back(flux);
  if (setup.keep_incoming) run.incoming.push_back(-direction);
  run.oriented_face.push_back(point.oriented_face());
}

/// Whether light that comes straight from the light is stored there.
bool stores_direct(const PathSetup& setup, const SurfacePoint& point) {
  if (!setup.parameters->store_direct || setup.caustics) return false;
  return setup.stores_hot_spots || !setup.rays->hot_spots->holds(setup.light, point.position);
}

/// Flux after the interaction, black where the path ends. From `roulette_start` on, a path survives
/// with the fraction of its largest channel that is left, and keeps that channel's flux: photons of
/// a light all weigh the same, which is what keeps the noise of the estimate low. Photons of long
/// paths weigh more.
glm::vec3 play_roulette(const PathSetup& setup, int bounce, const glm::vec3& before,
                        const glm::vec3& after, float u) {
  if (bounce < setup.parameters->roulette_start) return after;
  const float most = bounce < defaults::long_path ? 1.0f : defaults::largest_survival;
  const float survival = std::min(most, largest(after) / largest(before));
  return u < survival ? after / survival : glm::vec3(0.0f);
}

/// The most walks that one is split into at a surface, and of a whole path: more would add little
/// information.
constexpr int most_copies = 16;
constexpr std::uint32_t most_branches = 4096;

/// Light on its way.
struct Walk {
  RandomStream random;
  RayOrigin origin;
  glm::vec3 direction, flux;
  int bounce = 1;  ///< of the surface that it comes to next
  std::uint32_t cutouts = 0;
  bool unscattered = true;  ///< except by panes and cutouts, which light samples pass
};

/// `walk` after the surface where it arrived; nothing where it ended there.
std::optional<Walk> scattered(const PathSetup& setup, const SurfacePoint& point, bool opaque,
                              Walk walk, PathRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const RandomBlock numbers = walk.random.block(Purpose::photon_scattering, walk.bounce);
  const std::optional<Scattered> scattered =
      opaque ? scatter_opaque(scene, point, walk.direction, numbers)
             : scatter_specular(scene, point, walk.direction, numbers.uniform(choice_word));
  glm::vec3 left(0.0f);
  if (scattered) {
    left = play_roulette(setup, walk.bounce, walk.flux, walk.flux * scattered->weight,
                         numbers.uniform(roulette_word));
  }
  if (!(largest(left) > 0.0f)) {
    record.absorbed += luminance_of(walk.flux);
    return std::nullopt;
  }
  record.absorbed += luminance_of(walk.flux) - luminance_of(left);
  walk.unscattered = walk.unscattered && !opaque && scattered->direction == walk.direction &&
                     material_of(scene, point).thin;
  walk.flux = left;
  walk.direction = scattered->direction;
  walk.origin = point.origin_towards(walk.direction);
  ++walk.bounce;
  return walk;
}

enum WindowWord { store_word = 0, copies_word = 1, survival_word = 2 };

/// The weight of a photon that has landed, and that which it is to have there.
struct Weighed {
  float weight, window;
};

std::optional<Weighed> weighed(const PathSetup& setup, const SurfacePoint& point,
                               const glm::vec3& flux) {
  const std::optional<float> window = setup.windows->at(point.position, point.normal);
  if (!window) return std::nullopt;
  return Weighed{static_cast<float>(double{largest(flux)} / setup.unit_flux), *window};
}

/// Flux that is stored: one that is lighter than the window by chance, with the window's weight.
glm::vec3 thinned(const glm::vec3& flux, const Weighed& landed, float u) {
  if (landed.weight >= landed.window) return flux;
  return u * landed.window < landed.weight ? flux * (landed.window / landed.weight)
                                           : glm::vec3(0.0f);
}

/// Walks that go on from a walk twice as heavy as they are to be, or heavier: as many as have that
/// weight together.
int copies_of(float weight, float aim, float u) {
  if (weight <= 2 * aim) return 1;
  return static_cast<int>(std::min(weight / aim, static_cast<float>(most_copies - 1)) + u);
}

}  // namespace

void trace_photon_path(const PathSetup& setup, std::uint64_t path, PathRecord& record) {
  const Scene& scene = *setup.rays->scene;
  const RandomStream random(setup.parameters->seed, path, setup.light);
  const EmittedRay emitted =
      setup.caustics ? setup.emitter->emit_towards(
                           *setup.caustics, random,
                           sobol_point(static_cast<std::uint32_t>(path), setup.scramble))
                     : setup.emitter->emit(random);
  const glm::vec3 flux(glm::dvec3(emitted.color) / static_cast<double>(setup.paths));
  if (!(largest(flux) > 0.0f)) return;
  std::vector<Walk> others;  // of this path, where windows split it
  std::uint32_t branches = 0;

  for (std::optional<Walk> walk = Walk{random, emitted.origin, emitted.direction, flux};;) {
    if (!walk) {
      if (others.empty()) return;
      walk = others.back();
      others.pop_back();
    }
    const auto hit = setup.rays->intersect(walk->origin, walk->direction);
    if (!hit) {
      record.escaped += luminance_of(walk->flux);
      walk.reset();
      continue;
    }
    const SurfacePoint point = surface_hit(scene, *hit, walk->direction);
    const bool opaque = material_of(scene, point).interaction == Interaction::opaque;
    std::optional<Weighed> landed;
    if (setup.windows && opaque) landed = weighed(setup, point, walk->flux);
    const RandomBlock numbers =
        landed ? walk->random.block(Purpose::photon_window, walk->bounce) : RandomBlock({});
    const glm::vec3 stored =
        landed ? thinned(walk->flux, *landed, numbers.uniform(store_word)) : walk->flux;
    // In cutouts as well: the density is that of light on the whole triangle, by whose area the
    // estimate divides, and does not fall where a cutout is near.
    if (opaque && largest(stored) > 0.0f && !behind_cutout(scene, point)) {
      if (!walk->unscattered || stores_direct(setup, point))
        store(setup, point, walk->direction, stored, record.photons);
    }
    if (passes_cutout(scene, point, walk->random, Purpose::photon_cutouts, walk->cutouts)) {
      walk->origin = point.origin_towards(walk->direction);
      continue;
    }
    if ((opaque && setup.caustics) || walk->bounce >= setup.parameters->max_path_length) {
      record.absorbed += luminance_of(walk->flux);
      walk.reset();
      continue;
    }
    if (landed) {
      // Where photons are heavier than paths where these start, paths stay as light.
      const float aim = std::min(landed->window, setup.path_weight);
      const int copies = branches < most_branches
                             ? copies_of(landed->weight, aim, numbers.uniform(copies_word))
                             : 1;
      if (2 * landed->weight < aim) {
        const glm::vec3 left =
            thinned(walk->flux, {landed->weight, aim}, numbers.uniform(survival_word));
        record.absorbed += luminance_of(walk->flux) - luminance_of(left);
        walk->flux = left;
        if (!(largest(left) > 0.0f)) {
          walk.reset();
          continue;
        }
      } else if (copies > 1) {
        walk->flux /= static_cast<float>(copies);
        for (int copy = 1; copy < copies; ++copy) {
          Walk branch = *walk;
          branch.random = random.branch(++branches);
          if (const auto next = scattered(setup, point, opaque, branch, record))
            others.push_back(*next);
        }
      }
    }
    walk = scattered(setup, point, opaque, *walk, record);
  }
}

}  // namespace photile::trace

namespace photile {

namespace {

using trace::PathRecord;

/// Paths of one light that one task traces.
struct Chunk {
  std::uint32_t light;
  std::uint64_t first_path, last_path;
};

/// The seed index of paths that are aimed at mirrors and glass, which is the number of no pass.
constexpr std::uint32_t aimed_repeat = 0xFFFF'FFFFu;
/// The index of random numbers of emission that no point, direction or portal uses.
constexpr std::uint32_t aim_block = 0xFFFF'FFFFu;

/// Large enough to make a task's cost vanish, small enough to share work and to stop soon.
constexpr std::uint64_t paths_per_chunk = 4096;

void check(const PhotonTracerParameters& parameters) {
  check_setting("photons_emitted", setting_value(parameters.emitted_photons));
  check_setting("max_path_length", setting_value(parameters.max_path_length));
  check_setting("roulette_start", setting_value(parameters.roulette_start));
  const Shard& shard = parameters.shard;
  if (shard.index >= shard.count || shard.count > limits::max_shards) {
    throw UsageError("shard " + std::to_string(shard.index) + " of " + std::to_string(shard.count) +
                     ": the index counts from 0, of at most " + std::to_string(limits::max_shards));
  }
}

std::vector<Chunk> chunks_of(const std::vector<std::uint64_t>& paths_per_light,
                             const Shard& shard) {
  const std::uint64_t all =
      std::accumulate(paths_per_light.begin(), paths_per_light.end(), std::uint64_t{0});
  const std::uint64_t begin = shard.begin(all), end = shard.end(all);
  std::vector<Chunk> chunks;
  std::uint64_t before = 0;  // paths of the lights before
  for (std::uint32_t light = 0; light < paths_per_light.size(); ++light) {
    const std::uint64_t paths = paths_per_light[light];
    const std::uint64_t last = std::clamp(end, before, before + paths) - before;
    for (std::uint64_t first = std::clamp(begin, before, before + paths) - before; first < last;
         first += paths_per_chunk) {
      chunks.push_back({light, first, std::min(first + paths_per_chunk, last)});
    }
    before += paths;
  }
  return chunks;
}

std::uint64_t paths_in(const std::vector<Chunk>& chunks) {
  std::uint64_t paths = 0;
  for (const Chunk& chunk : chunks) paths += chunk.last_path - chunk.first_path;
  return paths;
}

std::vector<std::uint64_t> times(std::vector<std::uint64_t> counts, std::uint64_t factor) {
  for (std::uint64_t& count : counts) count *= factor;
  return counts;
}

std::vector<trace::LightEmitter> emitters_of(const Scene& scene) {
  const BoundingSphere bounds = bounding_sphere(scene);
  const auto portals = std::make_shared<trace::Portals>(scene);
  std::vector<trace::LightEmitter> emitters;
  emitters.reserve(scene.lights.size());
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light)
    emitters.emplace_back(scene, light, bounds, portals);
  return emitters;
}

/// Data that leads paths to where photons are needed; by default none.
struct Guidance {
  const trace::WeightWindows* windows = nullptr;
  std::uint64_t paths_per_photon = 1;        ///< that windows trace for each asked for
  const trace::Targets* caustics = nullptr;  ///< of paths of caustics alone
  bool stores_hot_spots = true;
};

/// The parameters of paths that are aimed at mirrors and glass: a separate seed, and more paths in
/// each pass.
PhotonTracerParameters aimed_at_targets(PhotonTracerParameters parameters) {
  parameters.seed = trace::seed_of_repeat(parameters.seed, aimed_repeat);
  for (std::uint64_t& before : parameters.paths_before) before *= defaults::aimed_paths;
  return parameters;
}

/// Traces all chunks. Slot i holds what chunk i left, whichever thread traced it.
std::vector<PathRecord> trace_chunks(const RayScene& scene,
                                     const PhotonTracerParameters& parameters,
                                     const std::vector<trace::LightEmitter>& emitters,
                                     const std::vector<Chunk>& chunks,
                                     const std::vector<std::uint64_t>& paths_per_light,
                                     const std::vector<double>& fractions, bool keep_incoming,
                                     const Guidance& guidance, Progress& progress) {
  std::vector<PathRecord> records(chunks.size());
  std::atomic<std::uint64_t> stored{0};
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    progress.throw_if_cancelled();
    const trace::FlushDenormals flush_denormals;
    const Chunk& chunk = chunks[c];
    const trace::PathSetup setup{&impl_of(scene),
                                 &parameters,
                                 &emitters[chunk.light],
                                 chunk.light,
                                 paths_per_light[chunk.light],
                                 keep_incoming,
                                 guidance.caustics,
                                 trace::RandomStream(parameters.seed, 0, chunk.light)
                                     .block(trace::Purpose::emission, aim_block),
                                 guidance.windows,
                                 static_cast<double>(guidance.paths_per_photon) /
                                     static_cast<double>(paths_per_light[chunk.light]),
                                 1.0f / static_cast<float>(guidance.paths_per_photon),
                                 guidance.stores_hot_spots};
    const std::uint64_t before =
        parameters.paths_before.empty() ? 0 : parameters.paths_before[chunk.light];
    for (std::uint64_t path = chunk.first_path; path < chunk.last_path; ++path)
      trace::trace_photon_path(setup, before + path, records[c]);
    // Only what is stored: a path is the same whether its light is in a group or not.
    if (const auto fraction = static_cast<float>(fractions[chunk.light]); fraction != 1.0f)
      for (glm::vec3& flux : records[c].photons.flux) flux *= fraction;

    const std::uint64_t so_far = stored += records[c].photons.size();
    if (so_far > limits::max_stored_photons)
      throw UsageError("emitted photons: " + std::to_string(parameters.emitted_photons) +
                       " leave more than " + std::to_string(limits::max_stored_photons) +
                       " stored photons; emit fewer");
    progress.advance(chunk.last_path - chunk.first_path);
  });
  return records;
}

/// Windows from pilots of few paths; none where light falls evenly enough, or where the pilots
/// would be more than a small part of the work.
std::optional<trace::WeightWindows> windows_of(const RayScene& ray_scene,
                                               const PhotonTracerParameters& parameters,
                                               const std::vector<trace::LightEmitter>& emitters,
                                               Progress& progress) {
  if (parameters.emitted_photons < defaults::pilots_from * defaults::pilot_paths) return {};
  const Scene& scene = ray_scene.scene();
  const std::vector<std::uint64_t> paths_per_light =
      photons_per_light(scene, defaults::pilot_paths, parameters.quota);
  const std::vector<Chunk> chunks = chunks_of(paths_per_light, {});
  const std::vector<double> fractions(scene.lights.size(), 1.0);
  PhotonTracerParameters pilot = parameters;
  pilot.paths_before = {};
  pilot.store_direct = true;
  pilot.keep_caustics = false;
  QuietProgress quiet(progress);
  std::optional<trace::WeightWindows> map;
  for (std::uint32_t round = 0; round <= defaults::pilots_with_windows; ++round) {
    // Separate paths, so that windows do not depend on the paths that they are used for.
    const trace::RandomBlock seed =
        trace::RandomStream(parameters.seed, 0, 0).block(trace::Purpose::photon_window, round);
    pilot.seed = std::uint64_t{seed.word(1)} << 32 | seed.word(0);
    const std::vector<PathRecord> records =
        trace_chunks(ray_scene, pilot, emitters, chunks, paths_per_light, fractions, false,
                     {.windows = map ? &*map : nullptr}, quiet);
    std::vector<trace::PilotPhoton> photons;
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const trace::PhotonRun& run = records[c].photons;
      const auto paths = static_cast<float>(paths_per_light[chunks[c].light]);
      for (std::size_t i = 0; i < run.size(); ++i)
        photons.push_back({run.position[i], glm::vec3(face_normal(scene, run.oriented_face[i])),
                           trace::largest(run.flux[i]) * paths});
    }
    if (map) {
      map->add(photons);
    } else {
      const BoundingSphere bounds = bounding_sphere(scene);
      if (!trace::hides_light(photons, impl_of(ray_scene), bounds)) return {};
      map.emplace(photons, bounds);
    }
  }
  return map;
}

/// The photons of all records.
///   groups   null where photons do not tell lights apart
Photons photons_of(std::vector<PathRecord>& records, const std::vector<Chunk>& chunks,
                   const LightGroups* groups, std::size_t oriented_face_count) {
  std::vector<trace::LayerRun> runs;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const std::uint32_t layer = groups == nullptr ? 0 : groups->group_of[chunks[c].light];
    runs.push_back({&records[c].photons, static_cast<std::uint16_t>(layer)});
  }
  return trace::sorted_photons(runs, groups != nullptr, oriented_face_count);
}

PhotonTracerResult traced(const RayScene& ray_scene, const PhotonTracerParameters& parameters,
                          bool hot_spots, Progress& progress) {
  const Stopwatch stopwatch;
  check(parameters);
  const Scene& scene = ray_scene.scene();
  const SceneNeeds& needs = ray_scene.needs();
  const std::size_t light_count = scene.lights.size();

  PhotonTracerResult result;
  const std::vector<trace::LightEmitter> emitters = emitters_of(scene);
  const std::vector<std::uint64_t> asked_per_light =
      photons_per_light(scene, parameters.emitted_photons, parameters.quota);
  const std::optional<trace::WeightWindows> windows =
      windows_of(ray_scene, parameters, emitters, progress);
  Guidance guidance;
  if (windows) guidance = {&*windows, defaults::paths_with_windows};
  guidance.stores_hot_spots = hot_spots;
  const std::vector<std::uint64_t> paths_per_light =
      times(asked_per_light, guidance.paths_per_photon);
  const std::vector<Chunk> chunks = chunks_of(paths_per_light, parameters.shard);

  progress.begin("trace photons", paths_in(chunks), "paths");
  const LightGroups groups = light_groups_of(scene);
  std::vector<PathRecord> records =
      trace_chunks(ray_scene, parameters, emitters, chunks, paths_per_light, groups.fraction,
                   needs.glossy, guidance, progress);

  result.stored_per_light.assign(light_count, 0);
  result.escaped_flux_per_light.assign(light_count, 0.0);
  result.absorbed_flux_per_light.assign(light_count, 0.0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const std::uint32_t light = chunks[c].light;
    result.stored_per_light[light] += records[c].photons.size();
    result.escaped_flux_per_light[light] += records[c].escaped;
    result.absorbed_flux_per_light[light] += records[c].absorbed;
  }
  const LightGroups* several = needs.several_lights() ? &groups : nullptr;
  const std::size_t oriented_faces = 2 * scene.triangle_count();
  result.photons = photons_of(records, chunks, several, oriented_faces);
  result.photons.emitted_per_light = paths_per_light;
  progress.end();
  if (parameters.keep_caustics) {
    result.caustics.first_of.assign(oriented_faces + 1, 0);
    if (needs.specular_paths) {
      const trace::Targets targets = trace::specular_targets(scene);
      const PhotonTracerParameters aimed = aimed_at_targets(parameters);
      const std::vector<std::uint64_t> aimed_per_light =
          times(asked_per_light, defaults::aimed_paths);
      const std::vector<Chunk> aimed_chunks = chunks_of(aimed_per_light, aimed.shard);
      progress.begin("trace caustics", paths_in(aimed_chunks), "paths");
      records = trace_chunks(ray_scene, aimed, emitters, aimed_chunks, aimed_per_light,
                             groups.fraction, needs.glossy, {.caustics = &targets}, progress);
      result.caustics = photons_of(records, aimed_chunks, several, oriented_faces);
      progress.end();
    }
    result.caustics.emitted_per_light = paths_per_light;
  }
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace

PhotonTracerResult trace_photons(const RayScene& scene, const PhotonTracerParameters& parameters,
                                 Progress& progress) {
  return traced(scene, parameters, true, progress);
}

PhotonTracerResult trace::trace_photons_beside_hot_spots(const RayScene& scene,
                                                         const PhotonTracerParameters& parameters,
                                                         Progress& progress) {
  return traced(scene, parameters, false, progress);
}

}  // namespace photile
