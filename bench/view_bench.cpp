// The window while the viewer moves: what each frame costs, beside the rays and the kernels that it
// cannot do without. 512 x 512, one sample a pixel, k = 50, a diffuse interior.
#include <tbb/parallel_for.h>

#include <cmath>

#include "photile/scene_renderer.hpp"
#include "support/bench_record.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"
#include "trace/flush_denormals.hpp"
#include "trace/ray_query.hpp"
#include "view/display.hpp"
#include "view/viewpoint.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

/// Frames a second walk and turn so far.
constexpr double metres_per_frame = 0.03, radians_per_frame = 0.01;

struct Frames {
  int count = 60;
  int side = 512;
};

/// Where the viewer is at a frame: there and back, so that any number of frames stays in the room.
Camera camera_at(const Scene& scene, int frame) {
  constexpr int turning_point = 15;
  const int step =
      std::abs((frame + turning_point) % (4 * turning_point) - 2 * turning_point) - turning_point;
  view::Viewpoint viewpoint(scene.cameras.front());
  viewpoint.turn(radians_per_frame * step, 0);
  viewpoint.walk(metres_per_frame * step, 0, 0);
  return viewpoint.camera();
}

/// Seconds of each part of a frame, one for each frame.
struct ViewTiming {
  Timing hits, estimate, film, other, display, total, bare_rays, bare_kernels;
};

double seconds_of_stage(const RunStatistics& statistics, const std::string& stage) {
  for (const StageStatistics& each : statistics) {
    if (each.stage == stage) return each.seconds;
  }
  return 0;
}

/// The first hits of a frame's rays and nothing else.
double bare_ray_seconds(const RayScene& rays, const Camera& camera, int side) {
  const Stopwatch stopwatch;
  tbb::parallel_for(0, side, [&](int y) {
    const trace::FlushDenormals flush_denormals;
    for (int x = 0; x < side; ++x) {
      const glm::dvec3 direction = camera.direction(x + 0.5, y + 0.5, side, side);
      const auto hit = trace::intersect(rays, glm::vec3(camera.position), glm::vec3(direction));
      if (hit && hit->triangle >= rays.scene().triangle_count()) std::abort();  // it is used
    }
  });
  return stopwatch.seconds();
}

/// Renders and displays the frames; the mix is the scene's.
void time_frames(const Scene& scene, SceneRenderer& renderer, const Frames& frames,
                 ViewTiming& timing) {
  const LightMix mix = LightMix::of(scene, defaults::lumen_per_watt);
  PrimaryHitParameters film;
  film.width = film.height = frames.side;
  film.samples_per_pixel = 1;
  view::DisplaySettings settings;
  for (int frame = -2; frame < frames.count; ++frame) {  // two to warm up
    view::Frame shown;
    shown.camera = camera_at(scene, frame);
    const Stopwatch stopwatch;
    RenderResult result = renderer.render(shown.camera, film);
    const double rendered = stopwatch.seconds();
    shown.layers = std::move(result.layers);
    if (frame == -2) settings.exposure = view::automatic_stops(shown, mix);
    const Stopwatch display_watch;
    view::display(shown, mix, settings);
    const double displayed = display_watch.seconds();
    if (frame < 0) continue;
    const double hits = seconds_of_stage(result.statistics, "primary hits");
    const double estimate = seconds_of_stage(result.statistics, "radiance estimate");
    const double added = seconds_of_stage(result.statistics, "film");
    timing.hits.seconds.push_back(hits);
    timing.estimate.seconds.push_back(estimate);
    timing.film.seconds.push_back(added);
    timing.other.seconds.push_back(rendered - hits - estimate - added);
    timing.display.seconds.push_back(displayed);
    timing.total.seconds.push_back(rendered + displayed);
  }
}

bool run(BenchOptions& options) {
  Frames frames;
  RenderParameters parameters;
  if (options.quick) {
    frames = {2, 32};
    parameters.photons.emitted_photons = 20'000;
  }
  BenchRecord record("view", options);
  const Scene scene = living_room();
  std::vector<Device> devices;
  devices.emplace_back(DeviceOptions{.selector = options.device});
  record.set_device(devices.front().info());
  record.set("k", parameters.neighbours);
  record.set("photons", parameters.photons.emitted_photons);
  record.set("side", frames.side);
  record.set("frames", frames.count);
  record.set("lights", light_groups_of(scene).groups.size());

  ViewTiming timing;
  {
    SceneRenderer renderer(scene, devices, parameters);
    time_frames(scene, renderer, frames, timing);
  }
  const RayScene rays(scene);
  for (int frame = 0; frame < frames.count; ++frame) {
    timing.bare_rays.seconds.push_back(
        bare_ray_seconds(rays, camera_at(scene, frame), frames.side));
  }
  // Kernels are timed by events, which cost the host something: on a device of their own.
  std::vector<Device> profiled;
  profiled.emplace_back(DeviceOptions{.selector = options.device, .profile = true});
  SceneRenderer renderer(scene, profiled, parameters);
  PrimaryHitParameters film;
  film.width = film.height = frames.side;
  film.samples_per_pixel = 1;
  for (int frame = -1; frame < frames.count; ++frame) {
    const double seconds = kernel_seconds_of(
        profiled.front(), [&] { renderer.render(camera_at(scene, frame), film); });
    if (frame >= 0) timing.bare_kernels.seconds.push_back(seconds);
  }
  record.add({{"primary hits", to_json(timing.hits)},
              {"radiance estimate", to_json(timing.estimate)},
              {"film", to_json(timing.film)},
              {"other", to_json(timing.other)},
              {"display", to_json(timing.display)},
              {"total", to_json(timing.total)},
              {"bare rays", to_json(timing.bare_rays)},
              {"bare kernels", to_json(timing.bare_kernels)}});
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Frames of the window while the viewer moves", "view");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
