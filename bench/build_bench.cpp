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
  PhotonMapStatistics statistics;
  const Timing map_time = measure(options.repeats, [&] {
    const PhotonMaps maps(device, *workload.scene, photons, groups, {.radius = radius});
    statistics = maps.statistics();
  });
  const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
  const SearchInput input{photons, filter, workload.scene->lights.size()};
  const Timing index_time =
      measure(options.repeats, [&] { make_nanoflann_search(input, Candidates::sorted_list); });
  const Timing embree_time = measure(options.repeats, [&] { make_embree_search(input); });
  record.add({{"workload", workload.name},
              {"photons", photons.size()},
              {"radius", radius},
              {"references", statistics.references},
              {"device bytes", statistics.device_bytes},
              {"groups", to_json(group_time)},
              {"maps", to_json(map_time)},
              {"nanoflann", to_json(index_time)},
              {"embree", to_json(embree_time)}});
}

bool run(BenchOptions& options) {
  std::vector<std::uint64_t> counts{100'000, 1'000'000, 4'000'000};
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
  CLI::App command("Time to build photon maps", "build");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
