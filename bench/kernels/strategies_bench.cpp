// What an estimate costs by tuning, k and cells: nanoseconds a hit, over whole discs and clipped
// ones, on a plane and in the living room. The defaults of each kind of device are chosen by it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "estimate/specialisation.hpp"
#include "photile/estimator.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

/// The device's own tuning, then those that differ from it in one respect.
std::vector<EstimateTuning> tunings_of(const DeviceInfo& device) {
  const EstimateTuning shipped = shipped_tuning(device);
  const bool lanes = shipped.strategy == EstimateStrategy::lanes;
  std::vector<EstimateTuning> tunings{shipped};
  const auto add_width = [&](int width) {
    if (width == shipped.vector_width) return;
    tunings.push_back(shipped);
    tunings.back().vector_width = width;
    if (lanes) {
      tunings.back().work_group_size = width;
      tunings.back().shuffles = shipped.shuffles && width <= estimate::warp_width;
    }
  };
  if (lanes) {
    for (const int width : estimate::lane_widths) add_width(width);
    if (shipped.shuffles) {
      tunings.push_back(tunings.back());
      tunings.back().vector_width = tunings.back().work_group_size = estimate::warp_width;
    }
    tunings.push_back(shipped_tuning(device, EstimateStrategy::select));
  } else {
    for (const int width : estimate::vector_widths) add_width(width);
  }
  tunings.push_back(shipped);
  tunings.back().hits_per_item = lanes ? 4 : 1;
  return tunings;
}

/// "lanes 32 x 4": the width, and the hits in turn.
std::string name_of(const EstimateTuning& tuning) {
  return fmt::format("{} {} x {}{}", photile::name_of(tuning.strategy), tuning.vector_width,
                     tuning.hits_per_item, tuning.shuffles ? ", shuffles" : "");
}

class StrategiesBench {
 public:
  explicit StrategiesBench(const BenchOptions& options)
      : options_(options),
        record_("strategies", options),
        device_({.selector = options.device, .profile = true}) {
    record_.set_device(device_.info());
  }

  void run(const Workload& workload) {
    const Photons photons = workload.photons(options_.quick ? 2'000 : 1'000'000);
    const Scene& scene = *workload.scene;
    // Each k is another kernel of every tuning: on PoCL those of lanes compile for minutes.
    for (const int k : options_.quick ? std::vector{50} : std::vector{50, 200}) {
      const double radius = automatic_radius(photons, k);
      const NeighbourGroups groups = default_groups(scene, photons, radius);
      const PrimaryHits hits = in_map_order(workload.hits, groups);
      const auto surface = std::make_shared<const SurfaceIndex>(
          index_surface(scene, photons, radius, defaults::group_angle_degrees));
      const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped,
                                            defaults::group_angle_degrees);
      const reference::ClippedArea clipped(scene, photons, *surface, defaults::group_angle_degrees);
      const EstimateCheck of_discs(oracle, photons.size(), {k, radius}, hits);
      const EstimateCheck of_clipped(oracle, photons.size(), {k, radius, &clipped}, hits);
      for (const float cells : {2.0f, 4.0f, 8.0f}) {
        const PhotonMaps maps(device_, scene, photons, groups,
                              {.radius = radius, .photons_per_cell = cells});
        for (const AreaMode area : all_area_modes) {
          nlohmann::json row{
              {"workload", workload.name}, {"k", k}, {"cells", cells}, {"area", name_of(area)}};
          measure(maps, scene, {.neighbours = k, .area = area, .surface = surface}, hits,
                  area == AreaMode::disc ? of_discs : of_clipped, row);
          record_.add(std::move(row));
        }
      }
    }
  }

  /// Whether all estimates were right.
  bool finish() const {
    record_.write();
    return faults_ == 0;
  }

 private:
  /// The tunings in turn, so that all see the same load.
  void measure(const PhotonMaps& maps, const Scene& scene, EstimateParameters parameters,
               const PrimaryHits& hits, const EstimateCheck& check, nlohmann::json& row) {
    struct Case {
      std::string name;
      Estimator estimator;
      LightTable estimates = {};
      double least = std::numeric_limits<double>::infinity();
    };
    std::vector<Case> cases;
    for (const EstimateTuning& tuning : tunings_of(device_.info())) {
      parameters.tuning = tuning;
      cases.push_back({name_of(tuning), Estimator(maps, scene, parameters)});
      cases.back().estimator.estimate(hits);  // compiles
    }
    for (int repeat = 0; repeat < options_.repeats.most; ++repeat) {
      for (Case& one : cases) {
        one.least = std::min(one.least, device_or_processor_seconds_of(device_, [&] {
                               one.estimates = one.estimator.estimate(hits);
                             }));
      }
    }
    for (Case& one : cases) {
      faults_ += check.count_faults(fmt::format("{}, {}", row.dump(), one.name), one.estimator,
                                    one.estimates);
      row[one.name] = std::round(1e11 * one.least / static_cast<double>(hits.size())) / 100;
    }
  }

  BenchOptions options_;
  BenchRecord record_;
  Device device_;
  std::uint64_t faults_ = 0;
};

bool run(const BenchOptions& options) {
  StrategiesBench bench(options);
  bench.run(plane_workload(options.quick ? 1'000 : 262'144));
  bench.run(interior_workload("living-room", living_room(), options.quick ? 32 : 512,
                              options.quick ? 24 : 384));
  return bench.finish();
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Time of the estimate by the tuning of its kernels", "strategies");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
