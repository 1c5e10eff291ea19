// A frame of a scene with maps of triangles, of patches, and of both (the setting maps). Modes take
// turns, and a frame is also told in processor time, which other programs disturb less.
#include <sys/resource.h>

#include "photile/estimator.hpp"
#include "photile/load_scene.hpp"
#include "photile/photons.hpp"
#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  BenchOptions common;
  std::string scene;
  std::uint64_t photons = 300'000;  ///< paths
  double radius = 0.1;              ///< metres
  int side = 512;                   ///< pixels
  bool triangles = true;
};

/// Processor time of all threads of this process, user and system.
double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// What is measured of one mode.
struct Mode {
  NamedMapMode mode;
  nlohmann::json row;
  std::unique_ptr<PhotonMaps> maps;
  std::unique_ptr<Estimator> estimator;
  Timing frame, hits_processor, estimate_processor;
};

Mode prepare(const NamedMapMode& mode, Device& device, const Scene& scene, const Photons& photons,
             double radius) {
  Mode prepared{mode, {{"maps", mode.name}, {"photons", photons.size()}}, {}, {}, {}, {}, {}};
  const Stopwatch group_watch;
  const NeighbourGroups groups = find_map_groups(scene, photons, mode.mode, {radius});
  prepared.row["groups seconds"] = group_watch.seconds();
  prepared.row["groups bytes"] = groups.bytes();
  const double before = device.compile_seconds();
  const Stopwatch build_watch;
  prepared.maps = std::make_unique<PhotonMaps>(device, scene, photons, groups,
                                               PhotonMapParameters{.radius = radius});
  prepared.row["build seconds"] = build_watch.seconds() - (device.compile_seconds() - before);
  const PhotonMapStatistics& statistics = prepared.maps->statistics();
  prepared.row["references per photon"] =
      static_cast<double>(statistics.references) / static_cast<double>(photons.size());
  prepared.row["number of maps"] = statistics.maps;
  prepared.row["map bytes"] = statistics.device_bytes;
  prepared.estimator = std::make_unique<Estimator>(*prepared.maps, scene, EstimateParameters{});
  return prepared;
}

void measure_frame(Mode& mode, const RayScene& rays, const PrimaryHitParameters& film) {
  const double begin = processor_seconds();
  const Stopwatch stopwatch;
  const PrimaryHitBatch batch = trace_primary_hits(rays, rays.scene().cameras.front(), film, 0,
                                                   film.height, mode.maps->map_of());
  const double hits_done = processor_seconds();
  const LightTable estimates = mode.estimator->estimate(batch.hits);
  mode.frame.seconds.push_back(stopwatch.seconds());
  mode.hits_processor.seconds.push_back(hits_done - begin);
  mode.estimate_processor.seconds.push_back(processor_seconds() - hits_done);
  mode.row["hits"] = batch.hits.size();
}

bool run(Settings& settings) {
  BenchRecord record("modes", settings.common);
  Device device({.selector = settings.common.device});
  record.set_device(device.info());
  Scene scene = load_scene(settings.scene);
  make_diffuse(scene);
  const RayScene rays(scene);
  PhotonTracerParameters paths;
  paths.emitted_photons = settings.photons;
  const Photons photons = trace_photons(rays, paths).photons;
  record.set("radius", settings.radius);
  record.set("paths", settings.photons);
  std::vector<NamedMapMode> modes{{"patch", MapMode::patch}, product_maps};
  if (settings.triangles) modes.insert(modes.begin(), paper_maps);
  std::vector<Mode> prepared;
  for (const NamedMapMode& mode : modes) {
    prepared.push_back(prepare(mode, device, scene, photons, settings.radius));
  }
  PrimaryHitParameters film;
  film.width = film.height = settings.side;
  film.samples_per_pixel = 1;
  for (int repeat = 0; repeat <= settings.common.repeats.most; ++repeat) {
    for (Mode& mode : prepared) {
      measure_frame(mode, rays, film);
      if (repeat > 0) continue;  // the first compiles and warms up
      mode.frame = mode.hits_processor = mode.estimate_processor = {};
    }
  }
  for (Mode& mode : prepared) {
    mode.row["frame"] = to_json(mode.frame);
    mode.row["processor time of primary hits"] = to_json(mode.hits_processor);
    mode.row["processor time of the estimate"] = to_json(mode.estimate_processor);
    record.add(mode.row);
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  CLI::App command("A frame with maps of triangles and of patches", "modes");
  add_options(command, settings.common);
  command.add_option("scene", settings.scene, "OBJ or glTF file")->required();
  command.add_option("--photons", settings.photons, "paths over all lights")->capture_default_str();
  command.add_option("--radius", settings.radius, "metres")->capture_default_str();
  command.add_option("--side", settings.side, "pixels of the picture")->capture_default_str();
  command.add_flag("--triangles,!--no-triangles", settings.triangles,
                   "with maps of each triangle, which may take many GB");
  return run_bench(command, argument_count, arguments, [&] { return run(settings); });
}
