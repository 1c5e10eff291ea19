// What the area of a density estimate costs: nanoseconds a hit over whole discs and over clipped
// ones, for each kernel, in the middle of a plate, at its edges, in its corners, and in interiors.
// Processor time of all threads, which other programs disturb least; on a GPU that of the kernels.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "photile/estimator.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/hit_sample.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct TestPoints {
  std::string name;
  PrimaryHits hits;
};

struct Subject {
  std::shared_ptr<const Scene> scene;
  Photons photons;
  std::vector<TestPoints> places;
};

/// The plate's hits: those in the middle, and those whose discs cross one edge, or a corner.
Subject plate(const BenchOptions& options) {
  const Workload workload = plane_workload(options.quick ? 20'000 : 1'000'000);
  Subject subject{workload.scene, workload.photons(options.quick ? 5'000 : 20'000), {}};
  const auto disc = static_cast<float>(
      std::sqrt(defaults::neighbours / (3.14159 * static_cast<double>(subject.photons.size()))));
  std::vector<std::uint32_t> middle, edge, corner;
  const auto from_edge = [](float x) { return std::min(x, 1 - x); };
  for (std::uint32_t i = 0; i < workload.hits.size(); ++i) {
    const glm::vec3& hit = workload.hits.position[i];
    const float x = from_edge(hit.x), y = from_edge(hit.y);
    if (std::min(x, y) > 0.25f) middle.push_back(i);
    if (std::min(x, y) < disc && std::max(x, y) > 2 * disc) edge.push_back(i);
    if (std::max(x, y) < disc) corner.push_back(i);
  }
  subject.places = {{"plate, middle", hits_at(workload.hits, middle).hits},
                    {"plate, edges", hits_at(workload.hits, edge).hits},
                    {"plate, corners", hits_at(workload.hits, corner).hits}};
  return subject;
}

Subject interior(const std::string& name, Scene scene, const BenchOptions& options) {
  const Workload workload =
      interior_workload(name, std::move(scene), options.quick ? 32 : 512, options.quick ? 24 : 384);
  return {workload.scene,
          workload.photons(options.quick ? 10'000 : 1'000'000),
          {{name, workload.hits}}};
}

class AreaBench {
 public:
  explicit AreaBench(const BenchOptions& options)
      : repeats_(options.repeats.most),
        record_("area", options),
        device_({.selector = options.device, .profile = true}) {
    record_.set_device(device_.info());
    record_.set("k", defaults::neighbours);
  }

  /// Whether all estimates were right.
  bool finish() const {
    record_.write();
    return faults_ == 0;
  }

  void run(const Subject& subject) {
    const double radius = automatic_radius(subject.photons, defaults::neighbours);
    const NeighbourGroups groups = default_groups(*subject.scene, subject.photons, radius);
    const PhotonMaps maps(device_, *subject.scene, subject.photons, groups, {.radius = radius});
    const auto surface = std::make_shared<const SurfaceIndex>(
        index_surface(*subject.scene, subject.photons, radius, defaults::group_angle_degrees));
    for (const TestPoints& place : subject.places) {
      run(subject, place.name, in_map_order(place.hits, groups), radius, maps, surface);
    }
  }

 private:
  /// The estimators in turn, so that all see the same load.
  void run(const Subject& subject, const std::string& place, const PrimaryHits& hits, double radius,
           const PhotonMaps& maps, const std::shared_ptr<const SurfaceIndex>& surface) {
    const Scene& scene = *subject.scene;
    constexpr double angle = defaults::group_angle_degrees;
    const reference::DensityOracle oracle(scene, subject.photons, reference::PhotonFilter::grouped,
                                          angle);
    const reference::ClippedArea clipped(scene, subject.photons, *surface, angle);
    struct Case {
      AreaMode area;
      DensityKernel kernel;
      Estimator estimator;
      Timing timing;
      LightTable estimates;
    };
    std::vector<Case> cases;
    for (const AreaMode area : all_area_modes) {
      for (const DensityKernel kernel : all_density_kernels) {
        cases.push_back(
            {area,
             kernel,
             Estimator(maps, scene, {.area = area, .kernel = kernel, .surface = surface}),
             {},
             {}});
        cases.back().estimator.estimate(hits);  // compiles
      }
    }
    for (int repeat = 0; repeat < repeats_; ++repeat) {
      for (Case& one : cases) {
        one.timing.seconds.push_back(device_or_processor_seconds_of(
            device_, [&] { one.estimates = one.estimator.estimate(hits); }));
      }
    }
    for (Case& one : cases) {
      const EstimateCheck check(oracle, subject.photons.size(),
                                {defaults::neighbours, radius,
                                 one.area == AreaMode::clipped ? &clipped : nullptr, one.kernel},
                                hits);
      faults_ += check.count_faults(
          fmt::format("{}, {}, {}", place, name_of(one.area), name_of(one.kernel)), one.estimator,
          one.estimates);
      record_.add({{"place", place},
                   {"area", name_of(one.area)},
                   {"kernel", name_of(one.kernel)},
                   {"hits", hits.size()},
                   {"nanoseconds per hit",
                    1e9 * one.timing.smallest() / static_cast<double>(hits.size())}});
    }
  }

  int repeats_;
  BenchRecord record_;
  Device device_;
  std::uint64_t faults_ = 0;
};

bool run(const BenchOptions& options) {
  AreaBench bench(options);
  bench.run(plate(options));
  bench.run(interior("living room", living_room(), options));
  if (std::optional<Scene> scene = classroom()) {
    bench.run(interior("classroom", std::move(*scene), options));
  }
  return bench.finish();
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Time of the estimate by area and kernel", "area");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
