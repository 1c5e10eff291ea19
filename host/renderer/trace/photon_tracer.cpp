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

  for (std::optional<Walk> walk = Walk{random, emitted.origin, emitted.direction, flux}; walk;) {
    const auto hit = setup.rays->intersect(walk->origin, walk->direction);
    if (!hit) {
      record.escaped += luminance_of(walk->flux);
      return;
    }
    const SurfacePoint point = surface_hit(scene, *hit, walk->direction);
    const bool opaque = material_of(scene, point).interaction == Interaction::opaque;
    // In cutouts as well: the density is that of light on the whole triangle, by whose area the
    // estimate divides, and does not fall where a cutout is near.
    if (opaque && !behind_cutout(scene, point) &&
        (!walk->unscattered || stores_direct(setup, point))) {
      store(setup, point, walk->direction, walk->flux, record.photons);
    }
    if (passes_cutout(scene, point, walk->random, Purpose::photon_cutouts, walk->cutouts)) {
      walk->origin = point.origin_towards(walk->direction);
      continue;
    }
    if ((opaque && setup.caustics) || walk->bounce >= setup.parameters->max_path_length) {
      record.absorbed += luminance_of(walk->flux);
      return;
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

/// What is stored of the light; by default all.
struct Kept {
  const trace::Targets* caustics = nullptr;  ///< of paths of caustics alone
  bool hot_spots = true;
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
                                     const Kept& kept, Progress& progress) {
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
                                 kept.caustics,
                                 trace::RandomStream(parameters.seed, 0, chunk.light)
                                     .block(trace::Purpose::emission, aim_block),
                                 kept.hot_spots};
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
  const std::vector<std::uint64_t> paths_per_light =
      photons_per_light(scene, parameters.emitted_photons, parameters.quota);
  const std::vector<Chunk> chunks = chunks_of(paths_per_light, parameters.shard);

  progress.begin("trace photons", paths_in(chunks), "paths");
  const LightGroups groups = light_groups_of(scene);
  std::vector<PathRecord> records =
      trace_chunks(ray_scene, parameters, emitters, chunks, paths_per_light, groups.fraction,
                   needs.glossy, {.hot_spots = hot_spots}, progress);

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
          times(paths_per_light, defaults::aimed_paths);
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
