#include <algorithm>
#include <utility>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/device_estimators.hpp"
#include "render/film.hpp"

namespace photile {
namespace {

/// Primary hits estimated at a time: enough to fill a device, little enough to stay in memory, and
/// fewer where each takes longer, so that progress is seen and a wish to stop is heard.
std::int64_t hits_per_batch(int neighbours) {
  return (std::int64_t{1} << 20) * defaults::neighbours /
         std::max(defaults::neighbours, neighbours);
}

PhotonTracerResult trace(const RayScene& rays, const RenderParameters& parameters,
                         RunStatistics& statistics, Progress& progress) {
  PhotonTracerResult traced = trace_photons(rays, parameters.photons, progress);
  const auto stored = static_cast<double>(traced.photons.size());
  std::uint64_t emitted = 0;
  for (const std::uint64_t count : traced.photons.emitted_per_light) emitted += count;
  statistics.push_back({"trace photons",
                        traced.seconds,
                        traced.photons.bytes(),
                        0,
                        {{"emitted photons", static_cast<double>(emitted)},
                         {"stored photons", stored},
                         {"stored photons per second", stored / traced.seconds}}});
  return traced;
}

NeighbourGroups find_groups(const Scene& scene, const Photons& photons,
                            const RenderParameters& parameters, double radius,
                            Progress& progress) {
  if (parameters.maps == MapMode::naive) return naive_groups(scene);
  Patches patches;
  // A global tree has no use for maps.
  if (parameters.structure != MapStructure::kdtree_global) {
    patches = find_patches(scene, radius, parameters.maps);
  }
  return merge_patches(
      scene,
      find_patch_groups(scene, std::move(patches), {radius, parameters.angle_degrees}, progress),
      photons);
}

NeighbourGroups group(const Scene& scene, const Photons& photons,
                      const RenderParameters& parameters, double radius,
                      RunStatistics& statistics, Progress& progress) {
  const Stopwatch stopwatch;
  NeighbourGroups groups = find_groups(scene, photons, parameters, radius, progress);
  const auto members = static_cast<double>(groups.members.size());
  statistics.push_back(
      {"neighbour groups",
       stopwatch.seconds(),
       groups.bytes(),
       0,
       {{"members", members},
        {"members per sided triangle", members / static_cast<double>(groups.offsets.size() - 1)},
        {"patches", static_cast<double>(groups.patches.count())}}});
  return groups;
}

std::vector<PhotonMaps> build_maps(std::span<Device> devices, const Scene& scene,
                                   const Photons& photons, const NeighbourGroups& groups,
                                   const PhotonMapParameters& parameters, RunStatistics& statistics,
                                   Progress& progress) {
  const Stopwatch stopwatch;
  std::vector<PhotonMaps> maps =
      build_maps_on_each(devices, scene, photons, groups, parameters, progress);
  const PhotonMapStatistics& built = maps.front().statistics();
  std::uint64_t device_bytes = 0;
  for (const PhotonMaps& one : maps) device_bytes += one.statistics().device_bytes;
  double compile_seconds = 0;  // devices compile at the same time
  for (const Device& device : devices) {
    compile_seconds = std::max(compile_seconds, device.compile_seconds());
  }
  statistics.push_back({"build photon maps",
                        stopwatch.seconds(),
                        0,
                        device_bytes,
                        {{"maps", static_cast<double>(built.maps)},
                         {"mixed maps", static_cast<double>(built.mixed_maps)},
                         {"references", static_cast<double>(built.references)},
                         {"references per photon",
                          static_cast<double>(built.references) /
                              static_cast<double>(std::max<std::uint64_t>(1, built.photons))},
                         {"largest map", static_cast<double>(built.largest_map)},
                         {"kernel compilation seconds", compile_seconds}}});
  return maps;
}

LightLayers estimate_picture(const RayScene& rays, const Camera& camera,
                             std::span<const Device> devices, const PhotonMaps& maps,
                             DeviceEstimators& estimators, const RenderParameters& parameters,
                             RunStatistics& statistics, Progress& progress) {
  const PrimaryHitParameters& film = parameters.film;
  StageStatistics hit_stage{"primary hits", 0, 0, 0, {}};
  StageStatistics estimate_stage{"radiance estimate", 0, 0, 0, {}};
  StageStatistics film_stage{"film", 0, 0, 0, {}};
  LightLayers layers(film.width, film.height, rays.scene().lights);
  const std::int64_t samples_per_row = std::int64_t{film.width} * film.samples_per_pixel;
  const int rows = static_cast<int>(std::clamp<std::int64_t>(
      hits_per_batch(parameters.neighbours) / samples_per_row, 1, film.height));
  std::uint64_t ray_count = 0, hit_count = 0;
  progress.begin("estimate radiance", static_cast<std::uint64_t>(film.height), "rows");
  for (int first = 0; first < film.height; first += rows) {
    progress.throw_if_cancelled();
    const int last = std::min(first + rows, film.height);
    const Stopwatch hit_watch;
    const PrimaryHitBatch batch = trace_primary_hits(rays, camera, film, first, last, maps.map_of());
    hit_stage.seconds += hit_watch.seconds();
    const Stopwatch estimate_watch;
    const Estimates estimates = estimators.estimate(batch.hits);
    estimate_stage.seconds += estimate_watch.seconds();
    const Stopwatch film_watch;
    add_to_film(layers, batch, estimates, 1.0f / static_cast<float>(film.samples_per_pixel));
    film_stage.seconds += film_watch.seconds();
    ray_count += batch.rays;
    hit_count += batch.hits.size();
    progress.advance(static_cast<std::uint64_t>(last - first));
  }
  progress.end();
  hit_stage.figures = {{"rays", static_cast<double>(ray_count)},
                       {"rays per second", static_cast<double>(ray_count) / hit_stage.seconds}};
  estimate_stage.figures = {
      {"hits", static_cast<double>(hit_count)},
      {"microseconds per hit",
       1e6 * estimate_stage.seconds / static_cast<double>(std::max<std::uint64_t>(1, hit_count))}};
  const std::vector<double> shares = estimators.shares();
  for (std::size_t i = 0; i < devices.size() && devices.size() > 1; ++i) {
    const DeviceInfo& device = devices[i].info();
    estimate_stage.figures.emplace_back("share of " + device.id + " " + device.name, shares[i]);
  }
  film_stage.host_bytes = layers.bytes();
  statistics.insert(statistics.end(), {hit_stage, estimate_stage, film_stage});
  return layers;
}

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
  RenderResult result;
  RunStatistics& statistics = result.statistics;

  const Stopwatch bvh_watch;
  const RayScene rays(scene);
  statistics.push_back({"ray tracing structure", bvh_watch.seconds(), rays.bytes(), 0, {}});

  PhotonTracerResult traced = trace(rays, parameters, statistics, progress);
  result.stored_photons = traced.photons.size();
  result.radius = parameters.radius > 0 ? parameters.radius
                                        : automatic_radius(traced.photons, parameters.neighbours);
  const NeighbourGroups groups =
      group(scene, traced.photons, parameters, result.radius, statistics, progress);
  const std::vector<PhotonMaps> maps = build_maps(
      devices, scene, traced.photons, groups,
      {result.radius, parameters.photons_per_cell, parameters.structure}, statistics, progress);
  traced.photons = Photons{};  // the maps hold copies
  DeviceEstimators estimators(devices, maps, scene, {parameters.neighbours, 0, parameters.tuning});
  result.layers = estimate_picture(rays, camera, devices, maps.front(), estimators, parameters,
                                   statistics, progress);
  result.device_shares = estimators.shares();
  return result;
}

RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress) {
  return render(scene, camera, std::span(&device, 1), parameters, progress);
}

}  // namespace photile
