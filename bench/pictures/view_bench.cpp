// The window while the viewer moves: what each frame costs, beside the rays and the kernels that it
// cannot do without. 512 x 512, one sample a pixel, k = 50, a diffuse interior.
#include <tbb/parallel_for.h>

#include <cmath>
#include <optional>
#include <span>

#include "photile/renderer.hpp"
#include "support/bench_record.hpp"
#include "support/kernel_seconds.hpp"
#include "support/workload.hpp"
#include "trace/ray_query.hpp"
#include "view/frame.hpp"
#include "view/navigation.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

/// Frames a second walk and turn so far.
constexpr double metres_per_frame = 0.03, radians_per_frame = 0.01;
constexpr int warm_up_frames = 2;

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

Film film_of(int side) { return {side, side, 1}; }

/// The first hits of a frame's rays and nothing else.
double bare_ray_seconds(const RayScene& rays, const Camera& camera, int side) {
  const Stopwatch stopwatch;
  const FilmDirections directions = camera.directions(side, side);
  tbb::parallel_for(0, side, [&](int y) {
    const trace::FlushDenormals flush_denormals;
    for (int x = 0; x < side; ++x) {
      const glm::vec3 direction(directions(x + 0.5, y + 0.5));
      const auto hit = trace::intersect(rays, glm::vec3(camera.position), direction);
      if (hit && hit->triangle >= rays.scene().triangle_count()) std::abort();  // it is used
    }
  });
  return stopwatch.seconds();
}

/// Renders frames and displays them.
class FrameTimer {
 public:
  FrameTimer(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
             int side)
      : mix_(LightMix::of(scene, defaults::lumen_per_watt)),
        film_(film_of(side)),
        renderer_(scene, devices, parameters) {}

  /// One frame, added to `timing`. The first says how bright all are shown.
  void time(const Camera& camera, ViewTiming& timing) {
    view::Frame shown;
    shown.camera = camera;
    const Stopwatch stopwatch;
    RenderResult result = renderer_.render(camera, film_);
    const double rendered = stopwatch.seconds();
    shown.layers = std::move(result.layers);
    if (!settings_) {
      settings_.emplace();
      settings_->exposure = view::automatic_stops(shown, mix_);
    }
    const Stopwatch display_watch;
    view::display(shown, mix_, *settings_);
    const double displayed = display_watch.seconds();
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

 private:
  LightMix mix_;
  Film film_;
  SceneRenderer renderer_;
  std::optional<view::DisplaySettings> settings_;
};

bool run(BenchOptions& options) {
  Frames frames;
  RenderParameters parameters;
  parameters.light_maps = LightMapMode::off;  // light_maps_bench.cpp measures those
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

  FrameTimer frame_timer(scene, devices, parameters, frames.side);
  const RayScene rays(scene);
  // Kernels are timed by events, which cost the host something: on a device of their own.
  std::vector<Device> profiled;
  profiled.emplace_back(DeviceOptions{.selector = options.device, .profile = true});
  SceneRenderer profiled_renderer(scene, profiled, parameters);
  const Film film = film_of(frames.side);
  ViewTiming timing;
  // In turn, so that whatever else the machine does meets all of them.
  for (int frame = -warm_up_frames; frame < frames.count; ++frame) {
    if (frame == 0) timing = {};
    const Camera camera = camera_at(scene, frame);
    frame_timer.time(camera, timing);
    timing.bare_rays.seconds.push_back(bare_ray_seconds(rays, camera, frames.side));
    timing.bare_kernels.seconds.push_back(
        kernel_seconds_of(profiled.front(), [&] { profiled_renderer.render(camera, film); }));
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
  add_options(command, options, Repeating::no);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
