// Building what is searched: neighbour groups and photon maps (duplicates included) against the
// index of nanoflann, which builds on one thread.
#include "photile/photon_maps.hpp"
#include "support/bench_record.hpp"
#include "support/host_search.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

void run_case(const Workload& workload, std::uint64_t photon_count, const BenchOptions& options,
              Device& device, BenchRecord& record) {
  const Photons photons = workload.photons(photon_count);
  const double radius = automatic_radius(photons, defaults::neighbours);
  NeighbourGroups groups;
  const Timing group_time =
      measure(options.repeats, [&] { groups = find_neighbour_groups(*workload.scene, {radius}); });
  nlohmann::json row{{"workload", workload.name},
                     {"photons", photons.size()},
                     {"radius", radius},
                     {"groups", to_json(group_time)}};
  for (const MapStructure structure : all_map_structures) {
    if (structure == MapStructure::brute_force) continue;
    PhotonMapStatistics statistics;
    const Timing timing = measure(options.repeats, [&] {
      const PhotonMaps maps(device, *workload.scene, photons, groups,
                            {.radius = radius, .structure = structure});
      statistics = maps.statistics();
    });
    row[std::string(name_of(structure))] = to_json(timing);
    if (structure != MapStructure::uniform_grid) continue;
    row["references"] = statistics.references;
    row["device bytes"] = statistics.device_bytes;
  }
  const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
  const SearchInput input{photons, filter, workload.scene->lights.size()};
  row["nanoflann"] = to_json(measure(options.repeats, [&] { make_nanoflann_index(photons); }));
  row["embree"] = to_json(measure(options.repeats, [&] { make_embree_search(input); }));
  record.add(std::move(row));
}

bool run(BenchOptions& options, std::vector<std::uint64_t> counts) {
  if (options.quick) {
    counts = {20'000};
    options.repeats = {1, 1};
  }
  BenchRecord record("build", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  record.set_version("nanoflann", nanoflann_version());
  record.set_version("embree", embree_version());
  record.set("k", defaults::neighbours);
  const Workload plane = plane_workload(1);
  const Workload interior = interior_workload("living-room", living_room(), 16, 16);
  for (const Workload* workload : {&plane, &interior}) {
    for (const std::uint64_t count : counts) run_case(*workload, count, options, device, record);
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  std::vector<std::uint64_t> counts{100'000, 1'000'000, 4'000'000};
  CLI::App command("Time to build photon maps", "build");
  add_options(command, options);
  command.add_option("--photons", counts, "photon counts");
  return run_bench(command, argument_count, arguments, [&] { return run(options, counts); });
}
