// Irradiance at points that a camera sees: gathered by rays beside the k nearest photons, in
// processor seconds a point and in error against paths. See docs/method/gathering.md.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cache/irradiance_gather.hpp"
#include "light/light_at_points.hpp"
#include "photile/load_scene.hpp"
#include "render/path_estimate.hpp"
#include "support/bench_record.hpp"
#include "support/gathering_photons.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Sizes {
  std::size_t points = 1'000;         ///< whose error is measured
  std::size_t timed_points = 20'000;  ///< more, for ends share estimates then
  int paths = 8'192;                  ///< of each point
  std::uint64_t gathered_photons = 500'000, looked_up_photons = 4'000'000;
};

/// Processor time of all threads of the process, the device's among them where it is this
/// processor.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<std::uint64_t> numbers(std::size_t count) {
  std::vector<std::uint64_t> result(count);
  std::iota(result.begin(), result.end(), std::uint64_t{0});
  return result;
}

/// Hits of the scene's first camera, spread over all that it sees.
PrimaryHits visible_points(const RayScene& rays, std::size_t count) {
  PrimaryHitParameters film;
  film.width = 256;
  film.height = 192;
  film.samples_per_pixel = 1;
  const PrimaryHits all =
      trace_primary_hits(rays, rays.scene().cameras.front(), film, 0, film.height).hits;
  PrimaryHits chosen;
  count = std::min(count, all.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t hit = i * all.size() / count;
    chosen.position.push_back(all.position[hit]);
    chosen.oriented_face.push_back(all.oriented_face[hit]);
    chosen.pixel.push_back(all.pixel[hit]);
    chosen.throughput.push_back(all.throughput[hit]);
    chosen.diffuse_albedo.push_back(all.diffuse_albedo[hit]);
    if (all.outgoing.empty()) continue;
    chosen.outgoing.push_back(all.outgoing[hit]);
    chosen.lobe.push_back(all.lobe[hit]);
  }
  return chosen;
}

/// Illuminance of all lights at each point.
std::vector<double> totals(const LightTable& estimates, std::size_t points,
                           std::span<const double> powers) {
  std::vector<double> result(points, 0.0);
  for (std::size_t point = 0; point < points; ++point) {
    estimates.for_each(point, [&](std::size_t layer, std::size_t i) {
      result[point] += powers[layer] * luminance(glm::dvec3(estimates.irradiance[i]));
    });
  }
  return result;
}

/// What paths find, and the variance of it.
struct Truth {
  std::vector<double> lux, variance;
};

Truth by_paths(const RayScene& rays, const PrimaryHits& points, std::span<const double> powers,
               int paths) {
  const PathEstimator estimator(rays, 2);
  Truth truth{std::vector<double>(points.size(), 0.0), std::vector<double>(points.size(), 0.0)};
  std::vector<std::uint64_t> number(points.size());
  for (int path = 0; path < paths; ++path) {
    for (std::size_t i = 0; i < number.size(); ++i) {
      number[i] = i * static_cast<std::uint64_t>(paths) + static_cast<std::uint64_t>(path);
    }
    const std::vector<double> one =
        totals(estimator.estimate(points, number), points.size(), powers);
    for (std::size_t i = 0; i < one.size(); ++i) {
      truth.lux[i] += one[i] / paths;
      truth.variance[i] += one[i] * one[i] / paths;
    }
  }
  for (std::size_t i = 0; i < truth.lux.size(); ++i) {
    truth.variance[i] = (truth.variance[i] - truth.lux[i] * truth.lux[i]) / (paths - 1);
  }
  return truth;
}

/// relMSE as bench/tools/picture_error.py has it, with and without the worst 5%, less the noise of
/// the paths; and the ratio of the means.
nlohmann::json errors_of(const std::vector<double>& lux, const Truth& truth) {
  const auto count = static_cast<double>(lux.size());
  const double mean = std::accumulate(truth.lux.begin(), truth.lux.end(), 0.0) / count;
  std::vector<double> errors, noise;
  double sum = 0;
  for (std::size_t i = 0; i < lux.size(); ++i) {
    const double scale = truth.lux[i] * truth.lux[i] + 0.01 * mean * mean;
    errors.push_back(std::pow(lux[i] - truth.lux[i], 2) / scale);
    noise.push_back(truth.variance[i] / scale);
    sum += lux[i] / count;
  }
  const double of_paths = std::accumulate(noise.begin(), noise.end(), 0.0) / count;
  const double all = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  std::sort(errors.begin(), errors.end());
  const auto kept = static_cast<std::ptrdiff_t>(0.95 * count);
  const double most = std::accumulate(errors.begin(), errors.begin() + kept, 0.0) / double(kept);
  return {{"rel_mse", all - of_paths},
          {"rel_mse_without_worst", most - of_paths},
          {"rel_mse_of_paths", of_paths},
          {"mean_ratio", sum / mean}};
}

RenderParameters parameters_of(std::uint64_t photons, int neighbours) {
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons;
  parameters.neighbours = neighbours;
  return parameters;
}

/// Runs `work` and returns its processor seconds.
template <class Work>
double timed(const Work& work) {
  const double before = processor_seconds();
  work();
  return processor_seconds() - before;
}

void measure_gathering(const std::string& name, const RayScene& rays, Device& device,
                       const PrimaryHits& points, const Truth& truth, const Sizes& sizes,
                       BenchRecord& record) {
  std::optional<test::GatheringPhotons> maps;
  const double set_up = timed([&] {
    maps.emplace(rays, std::span(&device, 1), parameters_of(sizes.gathered_photons, 100));
  });
  const PrimaryHits many = visible_points(rays, sizes.timed_points);
  for (const auto& [gathering, light_samples] :
       {std::pair{144, 96}, std::pair{25, 32}, std::pair{324, 216}, std::pair{144, 0},
        std::pair{0, 96}}) {
    cache::IrradianceGatherParameters parameters;
    parameters.rays = gathering;
    parameters.light_samples = light_samples;
    cache::IrradianceGather gather = maps->gather(parameters);
    LightTable light = gather.gather(points, numbers(points.size()));  // compiles kernels
    cache::IrradianceGather timed_gather = maps->gather(parameters);
    const double seconds = timed([&] { timed_gather.gather(many, numbers(many.size())); }) /
                           static_cast<double>(many.size());
    const cache::IrradianceGather::Costs& costs = timed_gather.costs();
    nlohmann::json row{{"scene", name},
                       {"method", "gathering"},
                       {"paths", sizes.gathered_photons},
                       {"rays", gathering},
                       {"looks", light_samples},
                       {"set_up_processor_seconds", set_up},
                       {"processor_seconds_a_point", seconds},
                       {"hits", costs.hits},
                       {"estimated", costs.estimated}};
    double stated = 0, squares = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LightTable::Total total = light.total(i, maps->layer_powers());
      const double variance = total.error * total.error + truth.variance[i];
      stated += total.error / std::max(1e-30, truth.lux[i]);
      squares += std::pow(total.luminance - truth.lux[i], 2) / std::max(1e-30, variance);
    }
    const auto count = static_cast<double>(points.size());
    row["stated_error_of_all_light"] = stated / count;
    if (gathering > 0 && light_samples > 0) {
      row["rms_of_stated_errors"] = std::sqrt(squares / count);
      row.update(errors_of(totals(light, points.size(), maps->layer_powers()), truth));
    }
    record.add(row);
  }
}

void measure_photons(const std::string& name, const RayScene& rays, Device& device,
                     const PrimaryHits& points, const Truth& truth, const Sizes& sizes,
                     BenchRecord& record) {
  const PrimaryHits many = visible_points(rays, sizes.timed_points);
  for (const int neighbours : {250, 1000}) {
    std::optional<test::GatheringPhotons> maps;
    const double set_up = timed([&] {
      maps.emplace(rays, std::span(&device, 1), parameters_of(sizes.looked_up_photons, neighbours));
    });
    const LightTable estimates = maps->light().at(points, Progress::none());  // compiles kernels
    const double seconds = timed([&] { maps->light().at(many, Progress::none()); });
    nlohmann::json row{{"scene", name},
                       {"method", "photons"},
                       {"paths", sizes.looked_up_photons},
                       {"neighbours", neighbours},
                       {"set_up_processor_seconds", set_up},
                       {"processor_seconds_a_point", seconds / static_cast<double>(many.size())}};
    row.update(errors_of(totals(estimates, points.size(), maps->layer_powers()), truth));
    record.add(row);
  }
}

bool run(BenchOptions& options, const std::vector<std::string>& files, Sizes sizes) {
  if (options.quick) sizes = {20, 100, 64, 20'000, 20'000};
  BenchRecord record("gather", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  record.set("points", sizes.points);
  record.set("timed points", sizes.timed_points);
  record.set("reference paths a point", sizes.paths);
  const auto measure_scene = [&](const std::string& name, const Scene& scene) {
    const RayScene rays(scene);
    const PrimaryHits points = visible_points(rays, sizes.points);
    const Truth truth = by_paths(rays, points, light::layer_powers(scene), sizes.paths);
    measure_gathering(name, rays, device, points, truth, sizes, record);
    measure_photons(name, rays, device, points, truth, sizes, record);
  };
  for (const std::string& file : files) {
    measure_scene(std::filesystem::path(file).stem().string(), load_scene(file));
  }
  if (files.empty()) measure_scene("living room", living_room());
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  std::vector<std::string> files;
  Sizes sizes;
  CLI::App command("Irradiance gathered by rays beside the k nearest photons", "gather");
  add_options(command, options, Repeating::no);
  command.add_option("scenes", files, "scene files; without any the living room");
  command.add_option("--points", sizes.points, "whose error is measured");
  command.add_option("--paths", sizes.paths, "of the reference, from each point");
  return run_bench(command, argument_count, arguments, [&] { return run(options, files, sizes); });
}
