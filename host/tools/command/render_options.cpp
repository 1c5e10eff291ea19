#include "tools/command/render_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "tools/command/direct_options.hpp"
#include "tools/command/quality_options.hpp"
#include "tools/command/scene_options.hpp"
#include "tools/command/validators.hpp"
#include "tools/preview/tev_connection.hpp"

namespace photile::app {
namespace {

constexpr std::array integrators{std::pair{"photon-map", Integrator::photon_map},
                                 std::pair{"path", Integrator::path}};
constexpr std::array quotas{std::pair{"balanced", PhotonQuota::balanced},
                            std::pair{"power", PhotonQuota::power},
                            std::pair{"equal", PhotonQuota::equal}};
/// Values with the names that the library gives them.
template <class Value, std::size_t count>
auto named(const std::array<Value, count>& values) {
  std::array<std::pair<std::string_view, Value>, count> table;
  for (std::size_t i = 0; i < count; ++i) table[i] = {name_of(values[i]), values[i]};
  return table;
}

const auto map_modes = named(all_map_modes);
const auto structures = named(all_map_structures);
const auto areas = named(all_area_modes);
const auto kernels = named(all_density_kernels);

template <class Table>
std::vector<std::string> words_of(const Table& table) {
  std::vector<std::string> words;
  for (const auto& [word, value] : table) words.emplace_back(word);
  return words;
}

template <class Table, class Value>
std::string word_for(const Table& table, Value wanted) {
  for (const auto& [word, value] : table) {
    if (value == wanted) return std::string(word);
  }
  return {};
}

template <class Table>
auto value_for(const Table& table, const std::string& wanted) {
  for (const auto& [word, value] : table) {
    if (word == wanted) return value;
  }
  throw UsageError(fmt::format("'{}' is not known; see photile render --help", wanted));
}

void add_view_group(CLI::App& command, RenderOptions& options) {
  PrimaryHitParameters& film = options.parameters.film;
  command.add_option("--camera", options.camera, "name or index; default: the first")
      ->type_name("NAME|INDEX")
      ->group("Picture");
  command
      .add_option(
          "--size", options.size,
          fmt::format("pixels; default: {} high, as wide as the camera says, else {}x{}",
                      defaults::image_height, defaults::image_width, defaults::image_height))
      ->type_name("WxH")
      ->transform(picture_size())
      ->group("Picture");
  command.add_option("--samples", film.samples_per_pixel, "primary rays per pixel")
      ->type_name("N")
      ->transform(count_between(1, limits::max_samples_per_pixel))
      ->capture_default_str()
      ->group("Picture");
}

void add_light_group(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--light", options.lights,
                  "power of a light in its unit, a factor (x2), a colour or off; repeatable")
      ->type_name("NAME=POWER|xFACTOR|#RRGGBB|KELVINK|off")
      ->allow_extra_args(false)
      ->group("Picture");
  command
      .add_option("--seed", options.parameters.film.seed, "the same seed gives the same picture")
      ->type_name("N")
      ->transform(count_between(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str()
      ->group("Picture");
}

void add_photon_group(CLI::App& command, RenderOptions& options) {
  RenderParameters& parameters = options.parameters;
  command.add_option("--photons", parameters.photons.emitted_photons, "paths over all lights")
      ->type_name("N")
      ->transform(count_between(limits::min_photons, limits::max_emitted_photons))
      ->capture_default_str()
      ->group("Photons");
  command
      .add_option("--passes", parameters.passes,
                  "photon passes, each of its share of the paths; default: by the memory")
      ->type_name("N")
      ->transform(count_between(1, limits::max_passes))
      ->group("Photons");
  options.quota = word_for(quotas, parameters.photons.quota);
  command.add_option("--quota", options.quota, "how the lights share the paths")
      ->type_name("")
      ->check(CLI::IsMember(words_of(quotas)))
      ->capture_default_str()
      ->group("Photons");
}

void add_estimate_group(CLI::App& command, RenderOptions& options) {
  RenderParameters& parameters = options.parameters;
  command.add_option("-k,--neighbours", parameters.neighbours, "photons of an estimate")
      ->type_name("N")
      ->transform(count_between(1, limits::max_neighbours))
      ->capture_default_str()
      ->group("Estimate");
  command
      .add_option("--least-neighbours", parameters.least_neighbours,
                  "each estimate has from N to -k photons, as many as its bias allows")
      ->type_name("N")
      ->transform(count_between(1, limits::max_neighbours))
      ->group("Estimate");
  command.add_option("--radius", parameters.radius, "metres; default: from the photons' density")
      ->type_name("M")
      ->transform(positive_number())
      ->group("Estimate");
  command.add_option("--angle", parameters.angle_degrees, "between the normals of a group")
      ->type_name("DEGREES")
      ->transform(number_between(0, 180))
      ->capture_default_str()
      ->group("Estimate");
  options.area = word_for(areas, parameters.area);
  command
      .add_option("--area", options.area,
                  "that photons are divided by; disc: dark borders and corners")
      ->type_name("")
      ->check(CLI::IsMember(words_of(areas)))
      ->capture_default_str()
      ->group("Estimate");
  options.kernel = word_for(kernels, parameters.kernel);
  command
      .add_option("--kernel", options.kernel,
                  "that photons are weighted by; cone, epanechnikov: less blur, more noise")
      ->type_name("")
      ->check(CLI::IsMember(words_of(kernels)))
      ->capture_default_str()
      ->group("Estimate");
  options.maps = word_for(map_modes, parameters.maps);
  command.add_option("--maps", options.maps, "naive: dark edges; patch: triangles share maps")
      ->type_name("")
      ->check(CLI::IsMember(words_of(map_modes)))
      ->capture_default_str()
      ->group("Estimate");
  options.structure = word_for(structures, parameters.structure);
  command.add_option("--structure", options.structure, "how photons are found; same neighbours")
      ->type_name("")
      ->check(CLI::IsMember(words_of(structures)))
      ->capture_default_str()
      ->group("Estimate");
  command.add_option("--photons-per-cell", parameters.photons_per_cell, "fineness of the grids")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->each([&options](const std::string&) { options.own_photons_per_cell = true; })
      ->group("Estimate");
}

void add_device_group(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--device", options.device.selector,
                  "OpenCL device: platform:device, index, cpu, gpu or a part of its name; "
                  "all, or several separated by commas; with /N split into N sub-devices, with =N "
                  "only N of its compute units; "
                  "default: the environment's PHOTILE_DEVICE, else the best")
      ->type_name("SELECTOR")
      ->group("Device");
  command
      .add_option("--memory", options.device.memory_bytes,
                  "that the device's buffers may take; default: all it has")
      ->type_name("SIZE")
      ->transform(byte_size())
      ->group("Device");
  command.add_flag("--no-cache", options.no_cache, "compile the kernels anew")->group("Device");
}

void add_run_group(CLI::App& command, RenderOptions& options) {
  command.add_option("--threads", options.threads, "of the host; 0 = all cores")
      ->type_name("N")
      ->transform(count_between(0, limits::max_threads))
      ->capture_default_str()
      ->group("Run");
  command.add_flag("-q,--quiet", options.quiet, "print errors only")->group("Run");
}

}  // namespace

void add_light_setting_options(CLI::App& command, RenderOptions& options) {
  command.add_option("SCENE", options.scene, "scene file: .obj, .gltf or .glb")
      ->required()
      ->type_name("");
  add_light_group(command, options);
  add_photon_group(command, options);
  add_estimate_group(command, options);
  add_scene_options(command, options.load, "Scene");
  add_light_options(command, options.load, "Lights");
  add_device_group(command, options);
  add_run_group(command, options);
}

void add_setting_options(CLI::App& command, RenderOptions& options) {
  add_light_setting_options(command, options);
  add_direct_options(command, options);
  add_view_group(command, options);
}

void add_integrator_option(CLI::App& command, RenderOptions& options) {
  options.integrator = word_for(integrators, options.integrates);
  command
      .add_option("--integrator", options.integrator,
                  "photon maps, or paths from the eye: unbiased, slower, without a device")
      ->type_name("")
      ->check(CLI::IsMember(words_of(integrators)))
      ->capture_default_str()
      ->group("Picture");
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  add_picture_options(command, options.pictures);
  add_setting_options(command, options);
  add_final_gather_option(command, options);
  add_integrator_option(command, options);
  command
      .add_flag("--tuned", options.tuned,
                "as photile devices --tune found best; other last bits than without")
      ->group("Estimate");
  command.add_flag("--profile", options.device.profile, "print the time of every kernel")
      ->group("Device");
  command.add_option("--stats", options.statistics, "write the summary as JSON")
      ->type_name("FILE")
      ->group("Run");
  add_saved_maps_options(command, options);
  for (const char* without : {"--save-maps", "--load-maps"}) {  // they hold no caustics apart
    command.get_option("--final-gather")->excludes(command.get_option(without));
  }
  add_quality_options(command, options.target);
  add_preview_option(command, options, "Output");
  command
      .add_option("--glare", options.glare,
                  "picture in which reflections above a limit are marked, in a colour per light")
      ->type_name("FILE.png")
      ->check(file_ending_in(".png"))
      ->group("Output");
  command
      .add_option("--glare-limit", options.glare_limit,
                  "above 100: luminance in cd/m2; else times the mean luminance of the picture")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->group("Output");
}

void add_preview_option(CLI::App& command, RenderOptions& options, const std::string& group) {
  command
      .add_option("--preview", options.preview,
                  fmt::format("show the picture in a running tev; default: {}", image::tev_address))
      ->type_name("[HOST:PORT]")
      ->expected(0, 1)
      ->default_str(image::tev_address)
      ->group(group);
}

void add_saved_maps_options(CLI::App& command, RenderOptions& options) {
  CLI::Option* save =
      command.add_option("--save-maps", options.save_maps, "keep the photons for --load-maps")
          ->type_name("FILE")
          ->group("Photons");
  command
      .add_option("--load-maps", options.load_maps,
                  "photons that --save-maps kept, of the same scene and options")
      ->type_name("FILE")
      ->excludes(save)
      ->group("Photons");
}

void apply_words(RenderOptions& options) {
  options.integrates = value_for(integrators, options.integrator);
  options.parameters.photons.quota = value_for(quotas, options.quota);
  options.parameters.maps = value_for(map_modes, options.maps);
  options.parameters.area = value_for(areas, options.area);
  options.parameters.kernel = value_for(kernels, options.kernel);
  options.parameters.structure = value_for(structures, options.structure);
  apply_direct_words(options);
  options.parameters.photons.seed = options.parameters.film.seed;
  options.device.use_program_cache = !options.no_cache;
  for (const auto& text : options.lights) options.light_changes.push_back(LightChange::parse(text));
}

void refuse_photon_map_options(const CLI::App& command) {
  const std::set<std::string> groups{"Photons", "Estimate", "Device", "Quality"};
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || groups.count(option->get_group()) == 0) continue;
    throw UsageError(fmt::format("{}: only photon maps use it; leave it out, or --integrator path",
                                 option->get_name()));
  }
}

const Camera& choose_camera(const Scene& scene, const std::string& selector) {
  if (selector.empty()) return scene.cameras.front();
  for (const Camera& camera : scene.cameras) {
    if (camera.name == selector) return camera;
  }
  const auto index = parse_count(selector);
  if (index && *index < scene.cameras.size()) return scene.cameras[*index];
  std::string known;
  for (const Camera& camera : scene.cameras) {
    known += (known.empty() ? "'" : ", '") + camera.name + "'";
  }
  throw UsageError(
      fmt::format("no camera '{}' in {}; it has {}", selector, scene.source.string(), known));
}

LightMix mix_of(const Scene& scene, const RenderOptions& options) {
  LightMix mix = LightMix::of(scene, options.load.lumen_per_watt);
  photile::apply(mix, options.light_changes);  // qualified: std::apply would match better
  return mix;
}

void set_film_size(PrimaryHitParameters& film, const std::string& size, const Camera& camera) {
  if (const auto pixels = parse_size(size)) {
    film.width = pixels->width;
    film.height = pixels->height;
  } else if (camera.aspect_ratio > 0) {
    const double width = std::round(camera.aspect_ratio * film.height);
    if (width > limits::max_image_side) {
      throw UsageError(
          fmt::format("the camera's aspect ratio {} makes the picture wider than {} "
                      "pixels; give --size",
                      camera.aspect_ratio, limits::max_image_side));
    }
    film.width = std::max(1, static_cast<int>(width));
  }
}

}  // namespace photile::app
