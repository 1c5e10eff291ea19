// Time and memory of a render, and of its file, against the number of lights at the same photons: a
// room with lamps in rows under its ceiling.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

namespace fs = std::filesystem;

struct Size {
  std::vector<std::size_t> lights{1, 4, 16, 64, 256};
  std::uint64_t photons = 1'000'000;  ///< emitted, over all lights
  std::uint32_t cells = 32;           ///< of the hall's walls
  int width = 512, height = 384;
};

/// The waved hall with a square or oblong of equal lamps a metre below its ceiling.
Scene hall_with_lamps(std::uint32_t cells, std::size_t lamps) {
  Scene scene = waved_hall(cells);
  const Light lamp = scene.lights.front();
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(lamps))));
  const std::size_t rows = (lamps + columns - 1) / columns;
  const float side = 4.0f;  // of the hall, metres
  scene.lights.clear();
  for (std::size_t i = 0; i < lamps; ++i) {
    Light light = lamp;
    light.name = fmt::format("lamp_{}", i);
    light.power = 1000.0 / static_cast<double>(lamps);
    light.position.x =
        side * (static_cast<float>(i % columns) + 0.5f) / static_cast<float>(columns);
    light.position.z = side * (static_cast<float>(i / columns) + 0.5f) / static_cast<float>(rows);
    scene.lights.push_back(light);
  }
  return scene;
}

/// Seconds of the stages of a render that this bench compares.
struct StageTimes {
  Timing trace, maps, estimate, film;

  void add(const RunStatistics& statistics) {
    for (const StageStatistics& stage : statistics) {
      if (stage.stage == "trace photons") trace.seconds.push_back(stage.seconds);
      if (stage.stage == "build photon maps") maps.seconds.push_back(stage.seconds);
      if (stage.stage == "radiance estimate") estimate.seconds.push_back(stage.seconds);
      if (stage.stage == "film") film.seconds.push_back(stage.seconds);
    }
  }
};

class LightsBench {
 public:
  LightsBench(const Size& size, const BenchOptions& options)
      : size_(size),
        repeats_(options.repeats),
        device_({.selector = options.device}),
        record_("lights", options),
        file_(fs::temp_directory_path() / fmt::format("photile-lights-{}.exr", getpid())) {
    record_.set_device(device_.info());
    record_.set("emitted photons", size.photons);
    record_.set("width", size.width);
    record_.set("height", size.height);
  }
  ~LightsBench() { fs::remove(file_); }

  void run() {
    for (const std::size_t lights : size_.lights) measure_lights(lights);
    record_.write();
  }

 private:
  void measure_lights(std::size_t lights) {
    const Scene scene = hall_with_lamps(size_.cells, lights);
    RenderParameters parameters;
    parameters.photons.emitted_photons = size_.photons;
    parameters.film.width = size_.width;
    parameters.film.height = size_.height;
    parameters.film.samples_per_pixel = 1;
    parameters.light_maps = LightMapMode::off;
    RenderResult result = render(scene, scene.cameras.front(), device_, parameters);
    StageTimes times;  // the first run compiled the kernels
    for (int i = 0; i < repeats_.most; ++i) {
      result = render(scene, scene.cameras.front(), device_, parameters);
      times.add(result.statistics);
    }
    const LightMix mix = LightMix::of(scene, defaults::lumen_per_watt);
    const auto picture = mixed_picture(result.layers, mix);
    const Timing write = measure(once_, [&] { write_exr(file_, *picture); });
    const std::uintmax_t file_bytes = fs::file_size(file_);
    const Timing relight = measure(once_, [&] {
      relit_picture(file_, {{"lamp_0", "x2"}})->root();
    });
    record_.add({{"lights", lights},
                 {"photons", result.stored_photons},
                 {"trace", to_json(times.trace)},
                 {"maps", to_json(times.maps)},
                 {"estimate", to_json(times.estimate)},
                 {"film", to_json(times.film)},
                 {"write", to_json(write)},
                 {"relight", to_json(relight)},
                 {"layer bytes", result.layers.bytes()},
                 {"dense bytes", std::uint64_t{16} * lights * picture->header().pixels()},
                 {"file bytes", file_bytes}});
  }

  const Size size_;
  const Repeats repeats_;
  const Repeats once_{1, 0};  ///< of files: after a warm-up
  Device device_;
  BenchRecord record_;
  const fs::path file_;
};

bool run(BenchOptions& options) {
  Size size;
  if (options.quick) {
    size = {{1, 4, limits::max_single_part_lights + 1}, 20'000, 4, 64, 48};
  }
  LightsBench(size, options).run();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  options.repeats.most = 3;
  CLI::App command("A render and its file against the number of lights", "lights");
  add_options(command, options);
  return run_bench(command, argument_count, arguments, [&] { return run(options); });
}
