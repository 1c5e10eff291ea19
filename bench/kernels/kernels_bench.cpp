// What kernels take: each of build and estimate beside the limits of the device, the estimate of
// each specialisation (one light or several, diffuse or glossy) with its bytes per photon, and
// where the time of every structure goes: compiler, kernels, transfers, host.
#include <fmt/format.h>

#include <ctime>
#include <optional>

#include "estimate/device_test.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/photons.hpp"
#include "photile/statistics.hpp"
#include "structures/structure.hpp"
#include "support/bench_record.hpp"
#include "support/device_limits.hpp"
#include "support/estimate_check.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Size {
  std::uint64_t photons = 1'000'000;
  int picture_side = 512;
  std::size_t copied_bytes = 256u << 20;
};

/// A scene with its photons and hits.
struct Subject {
  std::string name;
  Scene scene;
  Photons photons;
  PrimaryHits hits;
};

Subject plane(const SceneNeeds& needs, const Size& size) {
  estimate::PlaneSample sample =
      estimate::make_plane_sample(needs, defaults::neighbours, {size.photons, size.picture_side});
  return {"plane", std::move(sample.scene), std::move(sample.photons), std::move(sample.hits)};
}

/// The living room as its file has it: glossy, seven lights.
Subject whole_living_room(const Size& size) {
  Subject subject;
  subject.name = "living-room";
  subject.scene = living_room(Surfaces::as_in_the_file);
  const RayScene rays(subject.scene);
  PrimaryHitParameters film;
  film.width = film.height = size.picture_side;
  film.samples_per_pixel = 1;
  subject.hits = trace_primary_hits(rays, subject.scene.cameras.front(), film, 0, film.height).hits;
  subject.photons = traced_photons(rays, size.photons);
  return subject;
}

/// The photons and hits of `subject`, without what the needs leave out.
Subject restricted(Subject subject, const SceneNeeds& needs) {
  if (needs.light_count == 1) {
    subject.scene.lights.resize(1);
    for (std::uint32_t& light : subject.scene.triangle_light) light = light == 0 ? 0 : none;
    subject.photons.light.clear();
  }
  if (!needs.glossy) {
    make_diffuse(subject.scene);
    subject.photons.incoming.clear();
    subject.hits.outgoing.clear();
    subject.hits.lobe.clear();
  }
  return subject;
}

/// Grids included.
double bytes_per_reference(const PhotonMaps& maps) {
  const PhotonMapStatistics& statistics = maps.statistics();
  return static_cast<double>(statistics.device_bytes) / static_cast<double>(statistics.references);
}

class KernelsBench {
 public:
  KernelsBench(const BenchOptions& options, const Size& size)
      : repeats_(options.repeats),
        record_("kernels", options),
        device_({.selector = options.device, .profile = true}) {
    record_.set_device(device_.info());
    const DeviceLimits limits = measure_limits(device_, repeats_, size.copied_bytes);
    record_.set("limits", {{"copied bytes per second", limits.copied_bytes_per_second},
                           {"cached bytes per second", limits.cached_bytes_per_second},
                           {"operations per second", limits.operations_per_second}});
    record_.set("k", defaults::neighbours);
  }

  /// Whether all estimates were right.
  bool finish() const {
    record_.write();
    return faults_ == 0;
  }

  /// A row for the estimate of a specialisation.
  void specialisation(const Subject& subject) {
    const SceneNeeds needs = needs_of(subject.scene);
    const double radius = automatic_radius(subject.photons, defaults::neighbours);
    const PhotonMaps maps(device_, subject.scene, subject.photons,
                          default_groups(subject.scene, subject.photons, radius),
                          {.radius = radius});
    Estimator estimator(maps, subject.scene, {.area = AreaMode::disc});
    LightTable estimates;
    const Timing timing = measure_returned(repeats_, [&] {
      return kernel_seconds_of(device_, [&] { estimates = estimator.estimate(subject.hits); });
    });
    check(subject, defaults::neighbours, radius, estimator, estimates);
    record_.add({{"measured", "specialisation"},
                 {"workload", subject.name},
                 {"lights", needs.light_count},
                 {"glossy", needs.glossy},
                 {"hits", subject.hits.size()},
                 {"bytes per reference", bytes_per_reference(maps)},
                 {"seconds", to_json(timing)}});
  }

  /// A row for each kernel of the build, and one for the estimate.
  void kernels(const Subject& subject, int k) {
    const double radius = automatic_radius(subject.photons, k);
    const NeighbourGroups groups = default_groups(subject.scene, subject.photons, radius);
    const auto build = [&] {
      return PhotonMaps(device_, subject.scene, subject.photons, groups, {.radius = radius});
    };
    const PhotonMaps maps = build();
    Estimator estimator(maps, subject.scene, {.neighbours = k, .area = AreaMode::disc});
    LightTable estimates = estimator.estimate(subject.hits);  // compiles, as `build` has done
    std::map<std::string, Timing> timings;
    for (int i = 0; i < repeats_.most; ++i) {
      const auto seconds = seconds_by_kernel_of(device_, [&] {
        build();
        estimates = estimator.estimate(subject.hits);
      });
      for (const auto& [kernel, taken] : seconds) {
        if (taken > 0) timings[kernel].seconds.push_back(taken);
      }
    }
    check(subject, k, radius, estimator, estimates);
    const PhotonMapStatistics& statistics = maps.statistics();
    for (const auto& [kernel, timing] : timings) {
      record_.add({{"measured", "kernel"},
                   {"workload", subject.name},
                   {"k", k},
                   {"kernel", kernel},
                   {"photons", statistics.photons},
                   {"references", statistics.references},
                   {"cells", statistics.cells},
                   {"maps", statistics.maps},
                   {"patches", !maps.map_of().empty()},
                   {"hits", subject.hits.size()},
                   {"seconds", to_json(timing)}});
    }
  }

  /// A row for a structure: seconds of compiling, and of building and of estimating as split_times
  /// has them.
  void structure(const structures::Structure& structure, const Subject& subject, int k) {
    const double radius = automatic_radius(subject.photons, k);
    const NeighbourGroups groups = default_groups(subject.scene, subject.photons, radius);
    nlohmann::json row{{"measured", "structure"},
                       {"structure", structure.name},
                       {"k", k},
                       {"photons", subject.photons.size()},
                       {"hits", subject.hits.size()}};
    std::optional<PhotonMaps> maps;
    std::optional<Estimator> estimator;
    LightTable estimates;
    const auto build = [&] {
      estimator.reset();
      maps.emplace(structures::build(structure, device_, subject.scene, subject.photons, groups,
                                     {.radius = radius}));
      estimator.emplace(*maps, subject.scene,
                        EstimateParameters{.neighbours = k, .area = AreaMode::disc});
    };
    const auto estimate = [&] { estimates = estimator->estimate(subject.hits); };
    const double compiled_before = preparation_seconds();
    try {
      build();
      estimate();
      row["compile"] = preparation_seconds() - compiled_before;
      row["build"] = split_times(build);
      row["estimate"] = split_times(estimate);
      check(subject, k, radius, *estimator, estimates);
    } catch (const DeviceError& error) {  // the others may run
      row["failure"] = error.what();
    }
    record_.add(std::move(row));
  }

 private:
  /// Seconds spent so far until programs and kernels could run.
  double preparation_seconds() {
    const device::Context& context = device::context_of(device_);
    double seconds = context.compile_seconds();
    for (const device::KernelTime& time : context.kernel_times()) {
      seconds += time.preparation_seconds;
    }
    return seconds;
  }

  /// Seconds of a call: of its kernels, of its transfers, of all together, and of the host's
  /// processor, which where that is the device other programs disturb least.
  template <class Run>
  nlohmann::json split_times(const Run& run) {
    Timing kernels, transfers, all, processor;
    for (int i = 0; i < repeats_.most; ++i) {
      const double transferred = device::context_of(device_).transfer_seconds();
      const std::clock_t begin = std::clock();
      const Stopwatch stopwatch;
      const double device_seconds = kernel_seconds_of(device_, run);
      all.seconds.push_back(stopwatch.seconds());
      processor.seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      kernels.seconds.push_back(device_seconds);
      transfers.seconds.push_back(device::context_of(device_).transfer_seconds() - transferred);
    }
    return {{"kernels", to_json(kernels)},
            {"transfers", to_json(transfers)},
            {"all", to_json(all)},
            {"processor", to_json(processor)}};
  }

  void check(const Subject& subject, int k, double radius, Estimator& estimator,
             const LightTable& estimates) {
    const reference::DensityOracle oracle(subject.scene, subject.photons,
                                          reference::PhotonFilter::grouped,
                                          defaults::group_angle_degrees);
    const EstimateCheck check(oracle, subject.photons.size(), {k, radius}, subject.hits);
    faults_ += check.count_faults(fmt::format("{}, k = {}", subject.name, k), estimator, estimates);
  }

  Repeats repeats_;
  BenchRecord record_;
  Device device_;
  std::uint64_t faults_ = 0;
};

bool run(BenchOptions& options, bool plane_alone) {
  Size size;
  if (options.quick) {
    size = {10'000, 32, 1u << 20};
  }
  SceneNeeds diffuse;
  diffuse.light_count = 1;
  const Subject square = plane(diffuse, size);
  constexpr std::uint32_t several = 7;  // those of the living room
  KernelsBench bench(options, size);
  // Before their kernels are compiled for others; the grids', which all are built from, first.
  bench.structure(structures::named("uniform-grid"), square, 50);
  for (const structures::Structure& structure : structures::all()) {
    if (!structure.is_grid()) bench.structure(structure, square, 50);
  }
  bench.kernels(square, 50);
  bench.kernels(square, 200);
  if (plane_alone) return bench.finish();
  const Subject room = whole_living_room(size);
  for (const bool glossy : {false, true}) {
    for (const std::uint32_t lights : {1u, several}) {
      SceneNeeds needs;
      needs.glossy = glossy;
      needs.light_count = lights;
      bench.specialisation(plane(needs, size));
      bench.specialisation(restricted(room, needs));
    }
  }
  bench.kernels(restricted(room, diffuse), 50);
  return bench.finish();
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Kernels beside the limits of the device", "kernels");
  add_options(command, options);
  bool plane_alone = false;
  command.add_flag("--plane", plane_alone, "without the living room");
  return run_bench(command, argument_count, arguments, [&] { return run(options, plane_alone); });
}
