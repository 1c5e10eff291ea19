// The estimate of one workload again and again, for bench/kernels/profile.py. Prints when that
// begins and ends, in the seconds of the steady clock.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "photile/estimator.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  std::string workload = "plane";
  std::uint64_t photons = 1'000'000;
  int neighbours = defaults::neighbours;
  int side = 512;  ///< of the picture; its square is also the number of hits on the plane
  std::uint32_t cells = 100;  ///< of the waved hall
  double seconds = 4;
  std::string device;
};

Workload workload_of(const Settings& settings) {
  const int side = settings.side;
  if (settings.workload == "plane") {
    return plane_workload(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  }
  Scene scene = settings.workload == "living-room"  ? living_room()
                : settings.workload == "waved-hall" ? waved_hall(settings.cells)
                                                    : shared_interior(settings.workload).value();
  return interior_workload(settings.workload, std::move(scene), side, side);
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool run(const Settings& settings) {
  const Workload workload = workload_of(settings);
  const Photons photons = workload.photons(settings.photons);
  const double radius = automatic_radius(photons, settings.neighbours);
  Device device({.selector = settings.device});
  const NeighbourGroups groups = default_groups(*workload.scene, photons, radius);
  const PhotonMaps maps(device, *workload.scene, photons, groups, {.radius = radius});
  const PrimaryHits hits = in_map_order(workload.hits, groups);
  Estimator estimator(maps, *workload.scene,
                      {.neighbours = settings.neighbours, .area = AreaMode::disc});
  estimator.estimate(hits);  // compiles
  const double begin = now();
  while (now() < begin + settings.seconds) estimator.estimate(hits);
  std::printf("%.6f %.6f\n", begin, now());
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  CLI::App command("The estimate again and again", "profiled_estimate");
  // The last of an option given twice counts: bench/kernels/profile.py --quick makes cases smaller
  // so.
  command.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  command.add_option("--workload", settings.workload)
      ->check(CLI::IsMember({"plane", "living-room", "waved-hall", "classroom"}));
  command.add_option("--photons", settings.photons);
  command.add_option("--neighbours,-k", settings.neighbours);
  command.add_option("--side", settings.side);
  command.add_option("--cells", settings.cells);
  command.add_option("--seconds", settings.seconds);
  command.add_option("--device", settings.device);
  return run_bench(command, argument_count, arguments, [&] { return run(settings); });
}
