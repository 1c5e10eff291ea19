// What a start costs before the first kernel runs: opening the device and compiling the kernels
// with an empty cache, loading them with a full one. Each start is a process of its own, whose
// loading of shared libraries is timed too.
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "device/context.hpp"
#include "estimate/device_test.hpp"
#include "photile/estimator.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

namespace fs = std::filesystem;

/// Lights and lobes choose the kernels: these use the least and the most.
struct Variant {
  const char* name;
  bool glossy;
  std::uint32_t lights;
};
constexpr std::array variants{Variant{"diffuse, one light", false, 1},
                              Variant{"glossy, several lights", true, 7}};

/// An empty folder for one cache, removed at the end.
class CacheFolder {
 public:
  CacheFolder() {
    std::string name = (fs::temp_directory_path() / "photile-startup-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error(name +
                               ": cannot be made; set TMPDIR to a folder that can be written");
    }
    path_ = name;
  }
  ~CacheFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  CacheFolder(const CacheFolder&) = delete;
  CacheFolder& operator=(const CacheFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Seconds of the clock that all processes share.
double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The start itself, in the child: prints its seconds as JSON.
///   main_begun   of `now`
void start(const Variant& variant, const std::string& selector, double main_begun) {
  SceneNeeds needs;
  needs.glossy = variant.glossy;
  needs.light_count = variant.lights;
  const estimate::PlaneSample sample =
      estimate::make_plane_sample(needs, defaults::neighbours, {1000, 16});
  const NeighbourGroups groups = default_groups(sample.scene, sample.photons, sample.radius);
  const Stopwatch stopwatch;
  Device device({.selector = selector, .profile = true});
  const double opened = stopwatch.seconds();
  const auto picture = [&] {
    const PhotonMaps maps(device, sample.scene, sample.photons, groups, {.radius = sample.radius});
    Estimator(maps, sample.scene, {}).estimate(sample.hits);
  };
  picture();
  const double first = stopwatch.seconds() - opened;
  picture();
  const double second = stopwatch.seconds() - opened - first;
  nlohmann::json kernels;
  for (const device::KernelTime& time : device::context_of(device).kernel_times()) {
    kernels[time.kernel] = time.preparation_seconds;
  }
  nlohmann::json programs = nlohmann::json::object();
  for (const device::ProgramTime& time : device::context_of(device).program_times()) {
    programs[time.file] = programs.value(time.file, 0.0) + time.seconds;
  }
  const nlohmann::json line{{"main begun", main_begun},
                            {"open", opened},
                            {"prepare", first - second},
                            {"programs", std::move(programs)},
                            {"kernels", std::move(kernels)}};
  std::printf("%s\n", line.dump().c_str());
}

/// Starts a process of this bench with its cache in the folder.
nlohmann::json start_process(const fs::path& cache, std::size_t variant,
                             const std::string& selector) {
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  unsetenv("POCL_CACHE_DIR");
  if (!selector.empty()) setenv("PHOTILE_DEVICE", selector.c_str(), 1);
  const std::string command =
      "'" + fs::read_symlink("/proc/self/exe").string() + "' --child " + std::to_string(variant);
  const double begun = now();
  FILE* const output = popen(command.c_str(), "r");
  if (output == nullptr) throw std::runtime_error(command + ": cannot be started");
  std::string text;
  for (int c = std::fgetc(output); c != EOF; c = std::fgetc(output)) {
    text.push_back(static_cast<char>(c));
  }
  if (pclose(output) != 0) throw std::runtime_error(command + ": failed");
  nlohmann::json seconds = nlohmann::json::parse(text);
  seconds["load"] = seconds["main begun"].get<double>() - begun;
  return seconds;
}

/// The times of one cache state, over repeats.
struct StartTimings {
  Timing load, open, prepare;
  std::map<std::string, Timing> programs, kernels;

  void add(const nlohmann::json& seconds) {
    load.seconds.push_back(seconds["load"]);
    open.seconds.push_back(seconds["open"]);
    prepare.seconds.push_back(seconds["prepare"]);
    for (const auto& [file, taken] : seconds["programs"].items()) {
      programs[file].seconds.push_back(taken);
    }
    for (const auto& [kernel, taken] : seconds["kernels"].items()) {
      kernels[kernel].seconds.push_back(taken);
    }
  }

  nlohmann::json row(const Variant& variant, const char* cache) const {
    return {{"variant", variant.name},     {"cache", cache},
            {"load", to_json(load)},       {"open", to_json(open)},
            {"prepare", to_json(prepare)}, {"programs", by_name(programs)},
            {"kernels", by_name(kernels)}};
  }

 private:
  static nlohmann::json by_name(const std::map<std::string, Timing>& timings) {
    nlohmann::json rows;
    for (const auto& [name, timing] : timings) rows[name] = to_json(timing);
    return rows;
  }
};

bool run(BenchOptions& options) {
  BenchRecord record("startup", options);
  record.set_device(Device({.selector = options.device}).info());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    StartTimings empty, full;
    for (int repeat = 0; repeat < options.repeats.most; ++repeat) {
      const CacheFolder cache;
      empty.add(start_process(cache.path(), i, options.device));
      full.add(start_process(cache.path(), i, options.device));
    }
    record.add(empty.row(variants[i], "empty"));
    record.add(full.row(variants[i], "full"));
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const double begun = now();
  BenchOptions options;
  options.repeats.most = 3;
  int child = -1;
  CLI::App command("Time of a start with an empty and a full cache", "startup");
  add_options(command, options);
  command.add_option("--child", child)->group("");  // not for users
  return run_bench(command, argument_count, arguments, [&] {
    if (child < 0) return run(options);
    start(variants.at(static_cast<std::size_t>(child)), options.device, begun);
    return true;
  });
}
