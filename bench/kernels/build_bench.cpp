// Building what is searched: neighbour groups and photon maps (duplicates included) against the
// index of nanoflann, which builds on one thread.
#include "structures/structure.hpp"
#include "support/bench_record.hpp"
#include "support/host_search.hpp"
#include "support/naive_build.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

/// Photons of a workload and the radius of their maps.
struct Case {
  const Workload& workload;
  Photons photons;
  double radius;
};

/// Groups, and maps in grids or, with `every`, in each of the structures.
nlohmann::json map_times(const Case& c, const NamedMapMode& mode, bool every,
                         const Repeats& repeats, Device& device) {
  const Scene& scene = *c.workload.scene;
  NeighbourGroups groups;
  const Timing group_time =
      measure(repeats, [&] { groups = find_map_groups(scene, c.photons, mode.mode, {c.radius}); });
  nlohmann::json row{{"workload", c.workload.name},
                     {"maps of", mode.name},
                     {"photons", c.photons.size()},
                     {"radius", c.radius},
                     {"groups", to_json(group_time)}};
  for (const structures::Structure& structure : structures::all()) {
    const bool cells = structure.name == "uniform-grid";
    // Brute force has nothing to build.
    if (structure.name == "brute-force" || (!cells && !every)) continue;
    PhotonMapStatistics statistics;
    const Timing timing = measure(repeats, [&] {
      statistics =
          structures::build(structure, device, scene, c.photons, groups, {.radius = c.radius})
              .statistics();
    });
    row[structure.name] = to_json(timing);
    if (!cells) continue;
    row["references"] = statistics.references;
    row["device bytes"] = statistics.device_bytes;
  }
  return row;
}

void run_case(const Workload& workload, std::uint64_t photon_count, const BenchOptions& options,
              Device& device, BenchRecord& record) {
  Case c{workload, workload.photons(photon_count), 0};
  c.radius = automatic_radius(c.photons, defaults::neighbours);
  nlohmann::json row = map_times(c, product_maps, true, options.repeats, device);
  const Photons& photons = c.photons;
  const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
  const SearchInput input{photons, &filter, workload.scene->lights.size()};
  constexpr std::size_t leaf_size = 10;
  const Nanoflann nanoflann = nanoflann_of_system();
  row["nanoflann"] = to_json(measure(options.repeats, [&] { nanoflann.make(input, leaf_size); }));
  row["embree"] = to_json(measure(options.repeats, [&] { make_embree_search(input); }));
  record.add(std::move(row));
  row = map_times(c, paper_maps, false, options.repeats, device);
  const NaiveBuild naive = time_naive_build(*workload.scene, photons, c.radius,
                                            defaults::group_angle_degrees, options.repeats);
  row["naive"] = to_json(naive.timing);
  row["naive photons tested"] = naive.tested;
  row["naive references per photon"] = naive.references;
  record.add(std::move(row));
}

bool run(BenchOptions& options, std::vector<std::uint64_t> counts) {
  if (options.quick) {
    counts = {20'000};
  }
  BenchRecord record("build", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  record.set_version("nanoflann", nanoflann_of_system().version);
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
