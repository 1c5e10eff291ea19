// Time and memory of each stage of a render against the number of triangles and of photons. Each
// size runs in a process of its own, so that its peak of memory is its own and a size that does not
// fit fails alone; larger ones are not tried then.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/gltf_writer.hpp"
#include "support/subdivision.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

namespace fs = std::filesystem;

struct Settings {
  BenchOptions common;
  bool full = false;  ///< up to 4 million triangles and 100 million photons
  int seconds_per_size = 120;
  std::string child;  ///< the size that this process is to run
};

/// One point of a curve.
struct Size {
  std::string axis;       ///< what grows: "triangles" or "photons"
  std::string mesh;       ///< "hall", generated and read from a file; "living-room", "classroom"
  std::uint32_t detail;   ///< cells of the hall, or how often the other meshes are subdivided
  std::uint64_t photons;  ///< emitted
};

std::vector<Size> sizes(const Settings& settings) {
  constexpr std::uint64_t photons = 1'000'000;
  if (settings.common.quick) {
    return {{"triangles", "hall", 4, 20'000},
            {"triangles", "hall", 8, 20'000},
            {"triangles", "living-room", 0, 20'000},
            {"photons", "hall", 4, 10'000},
            {"photons", "hall", 4, 20'000}};
  }
  std::vector<Size> all;
  const std::uint32_t most_cells = settings.full ? 632 : 316;
  for (const std::uint32_t cells : {12u, 32u, 100u, 316u, 632u}) {
    if (cells <= most_cells) all.push_back({"triangles", "hall", cells, photons});
  }
  for (const char* mesh : {"living-room", "classroom"}) {
    const std::uint32_t most = std::string(mesh) == "classroom" ? 2 : settings.full ? 4 : 3;
    for (std::uint32_t times = 0; times <= most; ++times) {
      all.push_back({"triangles", mesh, times, photons});
    }
  }
  const std::uint64_t most_photons = settings.full ? 50'000'000 : 5'000'000;
  for (std::uint64_t emitted = 5'000; emitted <= most_photons; emitted *= 10) {
    all.push_back({"photons", "hall", 32, emitted});  // about twice as many are stored
  }
  return all;
}

/// Peak of the process's resident memory so far, in bytes.
std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

nlohmann::json stage_json(const std::string& name, double seconds, std::uint64_t host_bytes,
                          std::uint64_t device_bytes) {
  return {{"stage", name},
          {"seconds", seconds},
          {"host bytes", host_bytes},
          {"device bytes", device_bytes}};
}

/// The hall, written as a file and read again, which is timed.
Scene hall(std::uint32_t cells, nlohmann::json& stages) {
  const fs::path file = fs::temp_directory_path() / fmt::format("photile-scale-{}.gltf", getpid());
  const Scene generated = waved_hall(cells);
  write_gltf(generated, file);
  const Stopwatch stopwatch;
  Scene scene = load_scene(file);
  stages.push_back(stage_json("load", stopwatch.seconds(), 0, 0));
  fs::remove(file);
  fs::remove(fs::path(file).replace_extension(".bin"));
  scene.cameras = generated.cameras;
  return scene;
}

/// None where the scene's folder is missing.
std::optional<Scene> scene_of(const Size& size, nlohmann::json& stages) {
  if (size.mesh == "hall") return hall(size.detail, stages);
  std::optional<Scene> scene = size.mesh == "classroom" ? classroom() : living_room();
  for (std::uint32_t i = 0; scene && i < size.detail; ++i) scene = subdivided(*scene);
  return scene;
}

/// Compiles or loads the kernels of a diffuse scene, so that no stage is timed with that.
void prepare_kernels(Device& device, std::size_t lights, RenderParameters parameters) {
  Scene scene = waved_hall(4);
  scene.lights.resize(lights, scene.lights.front());
  parameters.photons.emitted_photons = 1000;
  render(scene, scene.cameras.front(), device, parameters);
}

/// Renders one size and returns its row; null where there is no such scene.
nlohmann::json measure_size(const Size& size, const std::string& selector) {
  nlohmann::json row{{"axis", size.axis}, {"mesh", size.mesh}};
  nlohmann::json stages = nlohmann::json::array();
  const std::optional<Scene> scene = scene_of(size, stages);
  if (!scene) return nullptr;
  Device device({.selector = selector});
  RenderParameters parameters;
  parameters.film.samples_per_pixel = 1;
  parameters.light_maps = LightMapMode::off;
  prepare_kernels(device, scene->lights.size(), parameters);
  parameters.photons.emitted_photons = size.photons;
  const Stopwatch stopwatch;
  const RenderResult result = render(*scene, scene->cameras.front(), device, parameters);
  const double seconds = stopwatch.seconds();
  double in_stages = 0;
  for (const StageStatistics& stage : result.statistics) {
    stages.push_back(stage_json(stage.stage, stage.seconds, stage.host_bytes, stage.device_bytes));
    in_stages += stage.seconds;
    for (const auto& [figure, value] : stage.figures) {
      if (figure == "references per photon") row[figure] = value;
    }
  }
  stages.push_back(stage_json("radius and the rest", seconds - in_stages, 0, 0));
  row["triangles"] = scene->triangle_count();
  row["photons"] = result.stored_photons;
  row["stages"] = std::move(stages);
  row["seconds"] = seconds;
  row["peak bytes"] = peak_resident_bytes();
  return row;
}

/// Bytes that the machine could give now.
std::uint64_t available_bytes() {
  std::ifstream file("/proc/meminfo");
  for (std::string name, unit; file >> name;) {
    std::uint64_t kibibytes = 0;
    file >> kibibytes;
    std::getline(file, unit);
    if (name == "MemAvailable:") return kibibytes * 1024;
  }
  throw std::runtime_error("/proc/meminfo: no MemAvailable");
}

/// Data of this process beyond this is refused, so that the machine does not run out of memory.
void limit_memory() {
  const rlim_t bytes = available_bytes() / 10 * 9;
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_DATA, &limit);
}

class ScaleBench {
 public:
  explicit ScaleBench(const Settings& settings)
      : settings_(settings), record_("scale", settings.common) {
    record_.set_device(Device({.selector = settings.common.device}).info());
    record_.set("full", settings.full);
    record_.set("seconds per size", settings.seconds_per_size);
  }

  void run() {
    std::vector<std::string> failed;  // curves that have come to their end
    const std::vector<Size> all = sizes(settings_);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string curve = all[i].axis + all[i].mesh;
      if (std::find(failed.begin(), failed.end(), curve) != failed.end()) continue;
      nlohmann::json row = run_process(i);
      if (row.is_null()) continue;
      if (row.contains("failure")) {
        failed.push_back(curve);
        row.update({{"axis", all[i].axis},
                    {"mesh", all[i].mesh},
                    {"detail", all[i].detail},
                    {"emitted photons", all[i].photons}});
      }
      record_.add(std::move(row));
    }
    record_.write();
  }

 private:
  /// The row that a process of this bench prints for a size, or why there is none.
  nlohmann::json run_process(std::size_t size) const {
    const fs::path self = fs::read_symlink("/proc/self/exe");
    std::string command =
        fmt::format("timeout {} '{}' --child {}", settings_.seconds_per_size, self.string(), size);
    if (settings_.common.quick) command += " --quick";
    if (settings_.full) command += " --full";
    if (!settings_.common.device.empty()) {
      command += fmt::format(" --device '{}'", settings_.common.device);
    }
    FILE* const output = popen((command + " 2>&1").c_str(), "r");
    if (output == nullptr) throw std::runtime_error(command + ": cannot be started");
    std::string line, last;
    for (int c = std::fgetc(output); c != EOF; c = std::fgetc(output)) {
      if (c != '\n') {
        line.push_back(static_cast<char>(c));
        continue;
      }
      last = std::move(line);
      line.clear();
    }
    const int status = pclose(output);
    constexpr int timed_out = 124;  // of timeout(1)
    if (status == 0) return nlohmann::json::parse(last);
    if (WIFEXITED(status) && WEXITSTATUS(status) == timed_out) {
      return {{"failure", fmt::format("more than {} s", settings_.seconds_per_size)}};
    }
    return {{"failure", last}};
  }

  const Settings& settings_;
  BenchRecord record_;
};

bool run(const Settings& settings) {
  if (settings.child.empty()) {
    ScaleBench(settings).run();
    return true;
  }
  if (!settings.common.quick) limit_memory();
  const Size size = sizes(settings).at(std::stoul(settings.child));
  std::printf("%s\n", measure_size(size, settings.common.device).dump().c_str());
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  CLI::App command("Stages of a render against triangles and photons", "scale");
  add_options(command, settings.common, Repeating::no);
  command.add_flag("--full", settings.full, "up to 4 million triangles and 100 million photons");
  command
      .add_option("--seconds-per-size", settings.seconds_per_size,
                  "a size that takes longer is given up")
      ->capture_default_str();
  command.add_option("--child", settings.child)->group("");  // not for users
  return run_bench(command, argument_count, arguments, [&] { return run(settings); });
}
