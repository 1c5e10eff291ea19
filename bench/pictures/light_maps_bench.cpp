// Frames from light maps: filling the nodes of a first view, a frame of filled nodes, a step, a
// look back, frames with a bounded time to fill, frames of film, and mixing lights. Processor
// seconds, which other work on the machine changes little; where a frame waits, seconds.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/gtx/rotate_vector.hpp>
#include <limits>
#include <optional>
#include <random>

#include "cache/charts.hpp"
#include "cache/node_mix.hpp"
#include "cache/surface_cache.hpp"
#include "estimate/photon_estimate.hpp"
#include "light/light_at_points.hpp"
#include "photile/image.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "render/frame_renderer.hpp"
#include "support/bench_record.hpp"
#include "support/workload.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  std::uint64_t paths = 4'000'000;
  int neighbours = 250;
  std::vector<std::pair<int, int>> sizes{{512, 512}, {1920, 1080}};
  std::size_t mixed_nodes = 130'000;
  std::string nodes;  ///< PNG of a frame with its lattice, "" = none
  double coarsest =
      0;              ///< metres between the coarsest nodes, 0 = as is; the finest stay as they are
  double detail = 0;  ///< metres between the finest nodes; 0 = as is
};

/// Where a viewer is who has walked and turned.
Camera moved(const Scene& scene, double metres, double degrees) {
  Camera camera = scene.cameras.front();
  const glm::dvec3 up(0, 1, 0);
  for (glm::dvec3* axis : {&camera.forward, &camera.up, &camera.right}) {
    *axis = glm::rotate(*axis, -glm::radians(degrees), up);
  }
  const glm::dvec3 ahead(camera.forward.x, 0, camera.forward.z);  // walkers stay level
  camera.position += metres * glm::normalize(ahead);
  return camera;
}

nlohmann::json json_of(const TimeTaken& taken) {
  return {{"seconds", taken.seconds}, {"processor seconds", taken.processor_seconds}};
}

Image image_of(const std::vector<glm::vec3>& picture, int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
    for (std::size_t i = 0; i < picture.size(); ++i) plane[i] = picture[i][channel];
  }
  return image;
}

/// Draws the lattice over a frame whose nodes are all there: lines at the borders of cells.
void draw_nodes(const RayScene& rays, const cache::LightMaps& maps, const Camera& camera,
                std::vector<glm::vec3>& picture, int width, int height) {
  constexpr float line = 0.07f;  // a part of a cell on each side
  const trace::FlushDenormals flush_denormals;
  const FilmDirections directions = camera.directions(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec3 direction(directions(x + 0.5, y + 0.5));
      const auto hit = trace::intersect(rays, glm::vec3(camera.position), direction);
      if (!hit) continue;
      const trace::SurfacePoint point = trace::surface_hit(rays.scene(), *hit, direction);
      cache::BilinearWeights blend{};
      if (maps.charts().chart_of()[point.oriented_face()] == none ||
          !maps.find(point.oriented_face(), point.position, blend)) {
        continue;
      }
      const glm::vec2 within(blend.weight[1] + blend.weight[3], blend.weight[2] + blend.weight[3]);
      const glm::vec2 from_line = glm::min(within, 1.0f - within);
      if (std::min(from_line.x, from_line.y) < line) {
        picture[static_cast<std::size_t>(y * width + x)] *= 0.35f;
      }
    }
  }
}

/// The path-traced reference of an interior of the shared scenes; nothing where it is missing.
std::optional<Image> reference_of(const std::string& name) {
  const char* folder = std::getenv("PHOTILE_SHARED_SCENES");
  const std::filesystem::path file =
      std::filesystem::path(folder ? folder : PHOTILE_SOURCE_DIR "/../shared/scenes") /
      "references" / (name + "-diffuse-256x192.exr");
  if (!std::filesystem::exists(file)) return std::nullopt;
  return read_image(file);
}

constexpr double all = std::numeric_limits<double>::infinity();

void measure_scene(const std::string& name, const Scene& scene, Device& device,
                   const Settings& settings, const BenchOptions& options, BenchRecord& record) {
  const RayScene rays(scene);
  PhotonTracerParameters tracing;
  tracing.emitted_photons = settings.paths;
  tracing.quota = PhotonQuota::power;
  const Photons photons = trace_photons(rays, tracing).photons;
  const double radius = automatic_radius(photons, settings.neighbours);
  const NeighbourGroups groups = default_groups(scene, photons, radius);
  const auto surface = std::make_shared<const SurfaceIndex>(
      index_surface(scene, photons, radius, defaults::group_angle_degrees));
  const EstimateParameters estimate{.neighbours = settings.neighbours, .surface = surface};
  const std::vector<double> powers = light::layer_powers(scene);
  std::vector<PhotonMaps> maps;
  maps.emplace_back(device, scene, photons, groups, PhotonMapParameters{.radius = radius});
  estimate::PhotonEstimate light(
      std::span(&device, 1), scene,
      {std::make_shared<const std::vector<PhotonMaps>>(std::move(maps)), estimate});
  cache::ValuedBy by_photons(light);
  cache::LightMapParameters light_maps =
      cache::light_map_parameters(scene, photons, settings.neighbours, radius,
                                  defaults::group_angle_degrees, 0, settings.detail, powers);
  if (settings.coarsest > 0) {
    light_maps.levels +=
        static_cast<int>(std::lround(std::log2(settings.coarsest / light_maps.spacing)));
    light_maps.spacing = settings.coarsest;
  }
  std::vector<glm::vec3> scales;
  for (const double power : powers) scales.emplace_back(power);

  const auto draw = [&](FrameRenderer& frames, const Camera& camera, int width, int height,
                        double fill_seconds) {
    std::vector<glm::vec3> picture(static_cast<std::size_t>(width * height));
    const Stopwatch stopwatch;
    const DrawnFrame drawn =
        frames.draw(camera, {width, height, 1}, scales, fill_seconds, picture, Progress::none());
    return std::pair(stopwatch.taken(), drawn);
  };
  {
    cache::SurfaceCache warm(rays, light_maps, light, by_photons, nullptr);  // compiles the kernels
    FrameRenderer frames(rays, warm.maps());
    draw(frames, scene.cameras.front(), 32, 32, all);
  }
  cache::SurfaceCache estimates(rays, light_maps, light, by_photons, nullptr);
  FrameRenderer frames(rays, estimates.maps());
  const auto [width, height] = settings.sizes.front();
  const TimeTaken fill = draw(frames, scene.cameras.front(), width, height, all).first;
  const cache::LightMapStatistics first = estimates.maps().statistics();
  nlohmann::json row{{"scene", name},
                     {"paths", settings.paths},
                     {"stored", photons.size()},
                     {"k", settings.neighbours},
                     {"spacing", estimates.maps().charts().spacing()},
                     {"levels", light_maps.levels},
                     {"charts", first.charts},
                     {"first view", json_of(fill)},
                     {"nodes", first.nodes},
                     {"tiles", first.tiles},
                     {"lights", powers.size()},
                     {"value bytes a light", first.value_bytes / powers.size()},
                     {"index bytes", first.index_bytes}};
  for (const auto& [w, h] : settings.sizes) {
    draw(frames, scene.cameras.front(), w, h, all);
    const Timing timing = measure_returned(options.repeats, [&] {
      return draw(frames, scene.cameras.front(), w, h, 0).first.processor_seconds;
    });
    row[std::to_string(w) + "x" + std::to_string(h)] = {
        {"processor seconds", to_json(timing)},
        {"processor nanoseconds a pixel", 1e9 * timing.median() / (double(w) * h)}};
  }
  // Each pixel's mean of 16 rays, nodes filled as it asks for them; the reference has all light.
  if (const auto reference = reference_of(name)) {
    cache::SurfaceCache compared(rays, light_maps, light, by_photons, nullptr);
    FrameRenderer framed(rays, compared.maps());
    const Film film{reference->width, reference->height, 16};
    std::vector<glm::vec3> picture(reference->pixels());
    framed.draw(scene.cameras.front(), film, scales, all, picture, Progress::none());
    row["relative MSE"] =
        picture_error(image_of(picture, film.width, film.height), *reference).relative_mse;
  }
  const auto look = [&](const char* what, double metres, double degrees) {
    const std::uint64_t before = estimates.maps().statistics().nodes;
    row[what] = json_of(draw(frames, moved(scene, metres, degrees), width, height, all).first);
    row[what]["nodes"] = estimates.maps().statistics().nodes - before;
  };
  look("step of 5 cm and 2 degrees", 0.05, 2);
  look("turn of 40 degrees", 0, 40);
  look("look back", 0, 180);

  // What the window does when somebody turns: frames of a thirtieth of a second.
  cache::SurfaceCache fresh(rays, light_maps, light, by_photons, nullptr);
  FrameRenderer bounded(rays, fresh.maps());
  draw(bounded, scene.cameras.front(), width, height, all);
  double longest = 0, drawing = 0;
  std::uint64_t count = 0, empty = 0;
  for (bool lacking = true; lacking; ++count) {
    const double spare = 1.0 / defaults::view_frames_per_second;
    const auto [taken, drawn] = draw(bounded, moved(scene, 0.05, 40), width, height,
                                     std::max(spare - drawing, 0.25 * spare));
    drawing = taken.seconds - drawn.fill_seconds;
    longest = std::max(longest, taken.seconds);
    lacking = drawn.lacking > 0;
    if (count == 0) empty = drawn.empty;
  }
  row["turn in bounded frames"] = {{"frames", count},
                                   {"longest seconds", longest},
                                   {"cells without light after the first", empty}};

  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("photile-film-{}.png", getpid());
  const Timing film = measure_returned(options.repeats, [&] {
    const Stopwatch stopwatch;
    std::vector<glm::vec3> picture(static_cast<std::size_t>(width * height));
    frames.draw(scene.cameras.front(), {width, height, 1}, scales, 0, picture, Progress::none());
    write_png(file, tone_map(image_of(picture, width, height), {false, 0}));
    return stopwatch.taken().processor_seconds;
  });
  std::filesystem::remove(file);
  if (!settings.nodes.empty()) {
    constexpr int side = 960;
    std::vector<glm::vec3> picture(static_cast<std::size_t>(side * side));
    frames.draw(scene.cameras.front(), {side, side, 4}, scales, all, picture, Progress::none());
    draw_nodes(rays, estimates.maps(), scene.cameras.front(), picture, side, side);
    write_png(settings.nodes, tone_map(image_of(picture, side, side), {}));
  }
  row["frame of film, processor seconds"] = to_json(film);
  record.add(row);
}

void measure_mixing(std::size_t nodes, std::size_t lights, const BenchOptions& options,
                    BenchRecord& record) {
  LightTable values(lights, false);
  values.irradiance.resize(nodes * lights);
  if (lights > max_dense_lights) {  // rows that hold every light: the worst case
    for (std::size_t node = 0; node <= nodes; ++node) values.first.push_back(node * lights);
    for (std::size_t i = 0; i < nodes * lights; ++i) {
      values.light.push_back(static_cast<std::uint16_t>(i % lights));
    }
  }
  std::mt19937 random(1);
  for (glm::vec3& value : values.irradiance) {
    value = glm::vec3(static_cast<float>(random() & 0xffff) / 65536.0f);
  }
  std::vector<glm::vec3> powers(lights, glm::vec3(1.0f));
  cache::NodeMix mixed;
  const auto mix = [&](bool all) {
    for (std::size_t i = 0; i < (all ? lights : 1); ++i) powers[i] *= 1.01f;
    const Stopwatch stopwatch;
    mixed.mix(values, nodes, powers);
    return stopwatch.taken().processor_seconds;
  };
  mix(true);
  const Timing all = measure_returned(options.repeats, [&] { return mix(true); });
  const Timing one = measure_returned(options.repeats, [&] { return mix(false); });
  record.add({{"mixed nodes", nodes},
              {"lights", lights},
              {"all lights, processor seconds", to_json(all)},
              {"one light, processor seconds", to_json(one)}});
}

bool run(BenchOptions& options, Settings settings, const std::string& only) {
  if (options.quick) {
    settings.paths = 20'000;
    settings.neighbours = 50;
    settings.sizes = {{32, 24}};
    settings.mixed_nodes = 1'000;
  }
  BenchRecord record("light_maps", options);
  Device device({.selector = options.device});
  record.set_device(device.info());
  const auto requested = [&](const char* name) { return only.empty() || only == name; };
  if (requested("mixing")) {
    for (const std::size_t lights : {1, 7, 64, 256}) {
      measure_mixing(settings.mixed_nodes, lights, options, record);
    }
  }
  if (requested("living room")) {
    measure_scene("living room", living_room(), device, settings, options, record);
  }
  for (const char* name : {"classroom", "kitchen"}) {
    if (options.quick || !requested(name)) continue;
    if (const auto scene = shared_interior(name)) {
      measure_scene(name, *scene, device, settings, options, record);
    }
  }
  record.write();
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  BenchOptions options;
  CLI::App command("Frames from light maps", "light_maps");
  add_options(command, options);
  std::string only;
  command.add_option("--only", only, "mixing, or one scene");
  Settings settings;
  command.add_option("--paths", settings.paths, "from all lamps")->capture_default_str();
  command.add_option("--nodes", settings.nodes, "PNG of the last scene's frame with its cells");
  command.add_option("--coarsest", settings.coarsest, "metres between the coarsest nodes");
  command.add_option("--detail", settings.detail, "metres between the finest nodes");
  return run_bench(command, argument_count, arguments,
                   [&] { return run(options, settings, only); });
}
