// Table 1 of Graglia et al. 2012: 100,000 triangles, 4,000,000 photons, 500 x 500 hits, the classic
// photon map against one per triangle. The paper leaves out build and groups, and does not state k.
#include <fmt/format.h>

#include "photile/estimator.hpp"
#include "structures/structure.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Size {
  std::uint32_t hall_cells = 100;  ///< 10 cells^2 triangles
  std::uint64_t photons = 4'000'000;
  int picture_side = 500;
};

bool run(BenchOptions& options) {
  Size size;
  if (options.quick) {
    size = {8, 20'000, 32};
  }
  BenchRecord record("paper", options);
  Device device({.selector = options.device, .profile = true});
  record.set_device(device.info());

  const Workload workload = interior_workload("waved hall", waved_hall(size.hall_cells),
                                              size.picture_side, size.picture_side);
  const Photons photons = workload.photons(size.photons);
  const double radius = automatic_radius(photons, defaults::neighbours);
  record.set("k", defaults::neighbours);
  record.set("radius", radius);
  record.set("triangles", workload.scene->triangle_count());
  record.set("photons", photons.size());
  record.set("hits", workload.hits.size());
  const reference::DensityOracle oracle(*workload.scene, photons, reference::PhotonFilter::grouped,
                                        defaults::group_angle_degrees);
  std::uint64_t faults = 0;

  struct Variant {
    std::string structure;
    NamedMapMode maps;
  };
  for (const auto& [structure, mode] :
       {Variant{"kdtree-global", product_maps}, Variant{"uniform-grid", paper_maps},
        Variant{"uniform-grid", product_maps}}) {
    NeighbourGroups groups;
    const Timing group_time = measure(options.repeats, [&] {
      groups = find_map_groups(*workload.scene, photons, mode.mode, {radius});
    });
    PhotonMapStatistics statistics;
    const auto build = [&] {
      return structures::build(structures::named(structure), device, *workload.scene, photons,
                               groups, {.radius = radius});
    };
    const Timing build_time = measure(options.repeats, [&] { statistics = build().statistics(); });
    const PhotonMaps maps = build();
    Estimator estimator(
        maps, *workload.scene,
        {.neighbours = defaults::neighbours, .radius = radius, .area = AreaMode::disc});
    const PrimaryHits hits = in_map_order(workload.hits, groups);
    // The search alone writes the neighbours that it found, which the estimate need not.
    const Timing search = measure_returned(options.repeats, [&] {
      return kernel_seconds_of(device, [&] { estimator.nearest(hits); });
    });
    const Timing kernels = measure_returned(options.repeats, [&] {
      return kernel_seconds_of(device, [&] { estimator.estimate(hits); });
    });
    LightTable estimates;
    const Timing whole = measure(options.repeats, [&] { estimates = estimator.estimate(hits); });
    const EstimateCheck check(oracle, photons.size(), {defaults::neighbours, radius}, hits);
    faults += check.count_faults(fmt::format("{}, maps of {}", structure, mode.name), estimator,
                                 estimates);
    nlohmann::json row{{"structure", structure},
                       {"maps of", mode.name},
                       {"references", statistics.references},
                       {"device bytes", statistics.device_bytes},
                       {"maps", to_json(build_time)},
                       {"search kernels", to_json(search)},
                       {"estimate kernels", to_json(kernels)},
                       {"estimate", to_json(whole)}};
    // Any photon may be a neighbour in the one global tree; it has no use for groups.
    if (structure == "uniform-grid") row["groups"] = to_json(group_time);
    record.add(std::move(row));
  }
  record.write();
  return faults == 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("The frame of the paper's table 1", "paper");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
