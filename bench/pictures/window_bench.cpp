// The window on a screen, driven by keys and mouse: how often it shows a new frame while somebody
// walks through what was seen before and into what was not.
//
//     xvfb-run --server-args "-screen 0 1920x1080x24" photile_bench_window --size 512x512
//
// Needs Debian's xvfb and xdotool. A screen in memory has no graphics processor: the window is
// drawn by the same cores. Seconds, and processor seconds of the whole process.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "photile/layered_picture.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"
#include "view/frame.hpp"
#include "view/viewer.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  std::string size = "512x512", scene = "living room";
  std::uint64_t paths = 1'000'000;
  int neighbours = 250;
  double frame_rate = defaults::view_frames_per_second;
};

constexpr double seconds_of_patience = 120;

/// What is seen from one press of a key to its release.
class Observer {
 public:
  void redrawn(const view::Redraw& redraw) {
    const std::lock_guard lock(mutex_);
    ++redraws_;
    if (!redraw.new_frame) return;
    paths_ = redraw.frame->emitted_photons;
    at_rest_ = redraw.frame->mixed.empty();
    if (redraw.moving && !at_rest_) {
      const double now = stopwatch_.seconds();
      if (last_frame_) gaps_.push_back(now - *last_frame_);
      last_frame_ = now;
      whole_ += redraw.frame->seconds;
    }
  }

  void begin() {
    const std::lock_guard lock(mutex_);
    stopwatch_ = {};
    gaps_.clear();
    last_frame_ = std::nullopt;
    whole_ = 0;
    redraws_ = 0;
  }

  nlohmann::json end(const std::string& what) {
    const std::lock_guard lock(mutex_);
    const TimeTaken taken = stopwatch_.taken();
    std::sort(gaps_.begin(), gaps_.end());
    const auto frames = static_cast<double>(gaps_.size() + 1);
    nlohmann::json row{{"what", what},
                       {"frames", frames},
                       {"redraws", redraws_},
                       {"processor ms a frame", 1e3 * taken.processor_seconds / frames},
                       {"worker's ms a frame", 1e3 * whole_ / frames}};
    if (!gaps_.empty()) {
      row["median ms between frames"] = 1e3 * gaps_[gaps_.size() / 2];
      row["ninth of ten"] = 1e3 * gaps_[gaps_.size() * 9 / 10];
      row["longest"] = 1e3 * gaps_.back();
    }
    return row;
  }

  bool shows_all(std::uint64_t paths) const {
    const std::lock_guard lock(mutex_);
    return at_rest_ && paths_ >= paths;
  }

 private:
  mutable std::mutex mutex_;
  Stopwatch stopwatch_;
  std::vector<double> gaps_;  ///< seconds between frames of a moving viewer
  std::optional<double> last_frame_;
  double whole_ = 0;
  std::uint64_t redraws_ = 0, paths_ = 0;
  bool at_rest_ = false;
};

/// Keys and the mouse, as xdotool moves them.
class Operator {
 public:
  Operator(Observer& observer, std::uint64_t paths, BenchRecord& record)
      : observer_(observer), paths_(paths), record_(record) {}

  void work(bool sunny) {
    rest();
    if (sunny) {
      walk("", {"Right"}), walk("the hour moved", {"Right"});
      return;
    }
    walk("", {"w"}), walk("", {"s"});  // all that is seen on the way has nodes now
    walk("ahead, through nodes that are there", {"w"});
    walk("back", {"s"});
    walk("aside, into surface that nobody saw", {"d"});
    walk("turned by 70 degrees, into surface that nobody saw", {}, 300);
  }

 private:
  static void xdotool(const std::string& arguments) {
    if (std::system(("xdotool " + arguments).c_str()) != 0) {
      throw std::runtime_error("xdotool " + arguments + " failed");
    }
  }
  static void sleep(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
  void rest() const {
    for (double waited = 0; !observer_.shows_all(paths_); waited += 0.1) {
      if (waited > seconds_of_patience) throw std::runtime_error("the window comes to no rest");
      sleep(0.1);
    }
  }

  ///   pixels   that the mouse drags the view
  void walk(const std::string& what, const std::vector<std::string>& keys, int pixels = 0) {
    constexpr int steps = 30;
    if (pixels > 0) xdotool("mousemove 480 300 mousedown 1");
    for (const std::string& key : keys) xdotool("keydown " + key);
    sleep(0.3);
    observer_.begin();
    for (int step = 0; step < steps; ++step) {
      sleep(1.5 / steps);
      if (pixels > 0) xdotool(fmt::format("mousemove_relative -- {} 0", -pixels / steps));
    }
    const nlohmann::json row = observer_.end(what);
    for (const std::string& key : keys) xdotool("keyup " + key);
    if (pixels > 0) xdotool("mouseup 1");
    if (!what.empty()) record_.add(row);
    sleep(0.5);
    rest();
  }

  Observer& observer_;
  const std::uint64_t paths_;
  BenchRecord& record_;
};

/// A room without lamps, under patches that the hour moves.
Scene sunny_room() {
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::patches, 0, 0, 0, defaults::view_sky_patches};
  return load_scene(PHOTILE_SOURCE_DIR "/scenes/gallery/sun-and-sky.gltf", options);
}

bool run(const BenchOptions& options, const Settings& settings) {
  BenchRecord record("window", options);
  const bool sunny = settings.scene == "sun and sky";
  const auto interior = sunny ? std::optional(sunny_room()) : shared_interior(settings.scene);
  const Scene scene = interior ? *interior : living_room();
  view::ViewerParameters parameters;
  parameters.frames_per_second = settings.frame_rate;
  RenderParameters& render = parameters.render;
  render.photons.emitted_photons = settings.paths;
  render.photons.quota = PhotonQuota::power;
  render.neighbours = settings.neighbours;
  render.film.samples_per_pixel = 1;
  if (std::sscanf(settings.size.c_str(), "%dx%d", &render.film.width, &render.film.height) != 2) {
    throw std::runtime_error("--size is WIDTHxHEIGHT");
  }
  record.set("size", settings.size);
  record.set("paths", settings.paths);
  record.set("k", settings.neighbours);

  if (sunny) parameters.situation.site = Site{52.5, 13.4, 1};

  Observer observer;
  std::atomic<bool> done{false};
  std::exception_ptr error;
  parameters.redrawn = [&](const view::Redraw& redraw) { observer.redrawn(redraw); };
  parameters.interrupted = [&] { return done.load(); };
  std::jthread operating([&] {
    try {
      Operator(observer, settings.paths, record).work(sunny);
    } catch (...) {
      error = std::current_exception();
    }
    done = true;
  });
  const auto open_devices = [&] {
    std::vector<Device> devices;
    devices.emplace_back(DeviceOptions{.selector = options.device});
    return devices;
  };
  view::run_viewer(scene, scene.cameras.front(), LightMix::of(scene, defaults::lumen_per_watt),
                   open_devices, std::move(parameters));
  operating.join();
  if (error) std::rethrow_exception(error);
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("The window, walked through", "window");
  add_options(command, options, Repeating::no);
  Settings settings;
  command.add_option("--size", settings.size, "of the window")->capture_default_str();
  command.add_option("--scene", settings.scene, "or classroom, kitchen, sun and sky")
      ->capture_default_str();
  command.add_option("--paths", settings.paths, "from all lamps")->capture_default_str();
  command.add_option("-k", settings.neighbours, "photons of an estimate")->capture_default_str();
  command.add_option("--frame-rate", settings.frame_rate, "aimed at")->capture_default_str();
  return run_bench(command, argument_count, arguments, [&] { return run(options, settings); });
}
