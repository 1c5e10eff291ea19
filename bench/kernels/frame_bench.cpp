// A frame of a walkthrough: the camera moved, photon maps stay. One sample a pixel.
#include "common/touched_memory.hpp"
#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/photons.hpp"
#include "photile/statistics.hpp"
#include "render/film.hpp"
#include "support/bench_record.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct FrameSize {
  int width, height;
};

/// Seconds of each stage, per repeat.
struct FrameTiming {
  Timing hits, estimate, kernels, film, total;  ///< kernels: the part of the estimate that they run
};

FrameTiming measure_frames(const RayScene& rays, const PhotonMaps& maps, Estimator& estimator,
                           const FrameSize& size, const Repeats& repeats) {
  PrimaryHitParameters film;
  film.width = size.width;
  film.height = size.height;
  film.samples_per_pixel = 1;
  FrameTiming timing;
  timing.total = measure(repeats, [&] {
    const Stopwatch stopwatch;
    const PrimaryHitBatch batch =
        trace_primary_hits(rays, rays.scene().cameras.front(), film, 0, film.height, maps.map_of());
    const double hits_done = stopwatch.seconds();
    LightTable estimates;
    timing.kernels.seconds.push_back(
        kernel_seconds_of(maps.device(), [&] { estimates = estimator.estimate(batch.hits); }));
    const double estimate_done = stopwatch.seconds();
    LightLayers layers(film.width, film.height, rays.scene());
    add_to_film(layers, batch, estimates, 1.0f);
    timing.hits.seconds.push_back(hits_done);
    timing.estimate.seconds.push_back(estimate_done - hits_done);
    timing.film.seconds.push_back(stopwatch.seconds() - estimate_done);
  });
  for (Timing* stage : {&timing.hits, &timing.estimate, &timing.kernels, &timing.film}) {
    stage->seconds.erase(stage->seconds.begin());  // the warm-up
  }
  return timing;
}

bool run(BenchOptions& options) {
  std::vector<FrameSize> sizes{{512, 512}, {1920, 1080}};
  PhotonTracerParameters paths;
  if (options.quick) {
    sizes = {{32, 24}};
    paths.emitted_photons = 20'000;
  }
  BenchRecord record("frame", options);
  Device device({.selector = options.device, .profile = true});
  record.set_device(device.info());
  const Scene scene = living_room();
  const RayScene rays(scene);
  const Photons photons = trace_photons(rays, paths).photons;
  const double radius = automatic_radius(photons, defaults::neighbours);
  record.set("k", defaults::neighbours);
  record.set("radius", radius);
  record.set("photons", photons.size());
  record.set("lights", scene.lights.size());
  for (const NamedMapMode& mode : {product_maps, paper_maps}) {
    const PhotonMaps maps(device, scene, photons,
                          find_map_groups(scene, photons, mode.mode, {radius}), {.radius = radius});
    Estimator estimator(maps, scene, {});
    for (const FrameSize& size : sizes) {
      const FrameTiming timing = measure_frames(rays, maps, estimator, size, options.repeats);
      record.add({{"maps", mode.name},
                  {"width", size.width},
                  {"height", size.height},
                  {"primary hits", to_json(timing.hits)},
                  {"estimate", to_json(timing.estimate)},
                  {"kernels", to_json(timing.kernels)},
                  {"film", to_json(timing.film)},
                  {"total", to_json(timing.total)}});
    }
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  keep_freed_memory();  // as the command does
  CLI::App command("A frame of a walkthrough", "frame");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
