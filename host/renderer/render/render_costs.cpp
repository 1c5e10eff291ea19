#include "render/render_costs.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace photile {
namespace {

double ratio(std::uint64_t a, std::uint64_t b) {
  return static_cast<double>(a) / static_cast<double>(std::max<std::uint64_t>(1, b));
}

double mean_of(const std::vector<std::uint32_t>& counts) {
  return ratio(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), counts.size());
}

/// The median; of an even number of counts the mean of the two in the middle, of none 0.
double median_of(std::vector<std::uint32_t> counts) {
  if (counts.empty()) return 0;
  std::sort(counts.begin(), counts.end());
  const std::size_t half = counts.size() / 2;
  const std::uint64_t sum = std::uint64_t{counts[half]} + counts[(counts.size() - 1) / 2];
  return 0.5 * static_cast<double>(sum);
}

}  // namespace

StageStatistics stage(const char* name, const StageCost& cost,
                      std::vector<std::pair<std::string, double>> figures) {
  return {name,
          cost.time.seconds,
          cost.time.processor_seconds,
          cost.host_bytes,
          cost.device_bytes,
          std::move(figures)};
}

void add_time(RunStatistics& stages, const char* name, const TimeTaken& time) {
  auto row = std::find_if(stages.begin(), stages.end(),
                          [&](const StageStatistics& one) { return one.stage == name; });
  if (row == stages.end()) row = stages.insert(row, stage(name, {}));
  row->seconds += time.seconds;
  row->processor_seconds += time.processor_seconds;
}

void StageCost::add(const TimeTaken& more_time, std::uint64_t more_host_bytes,
                    std::uint64_t more_device_bytes) {
  time += more_time;
  host_bytes = std::max(host_bytes, more_host_bytes);
  device_bytes = std::max(device_bytes, more_device_bytes);
}

void RenderCosts::start_picture() {
  hits = light_maps = estimate = film = {};
  sent.points = sent.point_bytes = 0;
  rays = light_map_nodes = hit_count = 0;
  estimate_compile_seconds = 0;
}

void RenderCosts::count(const PhotonTracerResult& traced) {
  for (const std::uint64_t paths : traced.photons.emitted_per_light) emitted_photons += paths;
  stored_photons += traced.photons.total();
  caustic_photons += traced.caustics.total();
}

void RenderCosts::add(std::span<const PhotonMaps> on_devices, const TimeTaken& time) {
  std::uint64_t device_bytes = 0, spilled_bytes = 0;
  for (const PhotonMaps& one : on_devices) {
    device_bytes += one.statistics().device_bytes - one.statistics().spilled_bytes;
    spilled_bytes += one.statistics().spilled_bytes;
  }
  build.add(time, spilled_bytes, device_bytes);
  references += on_devices.front().statistics().references;
  largest_map = std::max(largest_map, on_devices.front().statistics().largest_map);
}

void RenderCosts::note_last(const PhotonMapStatistics& statistics) {
  maps = statistics.maps;
  normal_filtered_maps = statistics.normal_filtered_maps;
  map_sizes = statistics.map_sizes;
}

void RenderCosts::add(const LightTotals& before, const LightTotals& now) {
  const TimeTaken filling = now.filling - before.filling;
  light_maps.add(filling - (now.building - before.building), now.node_bytes);
  light_map_nodes += now.nodes - before.nodes;
  light_map_errors = now.errors;
  estimate.add(now.asked - before.asked - filling);
  estimate_compile_seconds += now.compile_seconds - before.compile_seconds;
  hit_count += now.hits - before.hits;
}

RunStatistics RenderCosts::statistics() const {
  const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
  RunStatistics stages{
      stage("ray tracing structure", structure),
      stage("trace photons", trace,
            {{"emitted photons", number(emitted_photons)},
             {"stored photons", number(stored_photons)},
             {"stored photons per second", number(stored_photons) / trace.time.seconds}}),
      stage("automatic radius", radius),
      stage("neighbour groups", group,
            {{"members", number(group_members)},
             {"members per oriented face", ratio(group_members, groups)},
             {"patches", number(patches)}}),
      stage("surface index", surface,
            {{"components", number(components)}, {"leaves", number(surface_leaves)}}),
      stage("build photon maps", build,
            {{"maps", number(maps)},
             {"normal-filtered maps", number(normal_filtered_maps)},
             {"references", number(references)},
             {"references per photon", ratio(references, stored_photons)},
             {"photons per map, mean", mean_of(map_sizes)},
             {"photons per map, median", median_of(map_sizes)},
             {"photons per map, largest", number(largest_map)},
             {"kernel compilation seconds", compile_seconds}}),
      stage("prepare estimates", estimators),
      stage("primary hits", hits,
            {{"rays", number(rays)}, {"rays per second", number(rays) / hits.time.seconds}})};
  if (light_maps.time.seconds > 0) {
    std::vector<std::pair<std::string, double>> figures{{"new nodes", number(light_map_nodes)}};
    const double error = light_map_errors.mean();
    if (error > 0) figures.emplace_back("standard error percent", 100 * error);
    stages.push_back(stage("light maps", light_maps, std::move(figures)));
  }
  std::vector<std::pair<std::string, double>> estimate_figures{
      {"hits", number(hit_count)},
      {"kernel compilation seconds", estimate_compile_seconds},
      {"microseconds per hit",
       hit_count == 0
           ? 0.0
           : 1e6 * (estimate.time.seconds - estimate_compile_seconds) / number(hit_count)}};
  estimate_figures.insert(estimate_figures.end(), fractions.begin(), fractions.end());
  stages.push_back(stage("radiance estimate", estimate, std::move(estimate_figures)));
  if (!processes.empty()) stages.push_back(stage("exchange", exchange, processes));
  stages.push_back(stage("film", film));
  stages.push_back(stage("release memory", release));
  return stages;
}

}  // namespace photile
