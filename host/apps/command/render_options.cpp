#include "command/render_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <set>

#include "command/processes.hpp"
#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "publish/published_room.hpp"
#include "reading/camera_path.hpp"

namespace photile::app {
namespace {

constexpr std::array all_integrators{Integrator::photon_map, Integrator::path};

}  // namespace

void add_view_options(const OptionGroup& picture, RenderOptions& options) {
  picture.add("--camera", options.camera, "NAME|INDEX|FILE.vf",
              "camera by name or index, or a Radiance view file (.vf); default: the first");
  const auto add_point = [&](const char* name, std::vector<double>& point, const char* help) {
    picture
        .add(name, point, "X,Y,Z", help,
             number_between(-limits::max_coordinate, limits::max_coordinate))
        ->delimiter(',')
        ->expected(3);
  };
  add_point("--eye", options.eye,
            "position of the camera, metres in the axes of the file; photile info prints its "
            "extents; default: that of --camera");
  add_point("--look-at", options.look_at,
            "point that the camera looks at; default: straight ahead");
}

void add_run_group(CLI::App& command, RenderOptions& options) {
  const OptionGroup run(command, "Run");
  run.add("--threads", options.threads, "N", "threads on the host; 0: one per core",
          count_between(0, limits::max_threads))
      ->capture_default_str();
  run.flag("-q,--quiet", options.quiet, "print warnings and errors only");
}

void add_setting_options(CLI::App& command, RenderOptions& options,
                         std::initializer_list<std::string_view> without, const Settings& more) {
  add_scene_file(command, options.scene);
  const OptionGroup picture(command, "Picture");
  add_light_change_option(picture, options.lights);
  add_mood_options(picture, options.mood);
  add_settings(command, options.parameters, without);
  add_set_option(command, {rendering_settings(options.parameters, without),
                           scene_settings(options.load), device_settings(options.device), more});
  add_scene_options(command, options.load);
  add_light_options(command, options.load);
  OptionGroup(command, "Device")
      .add("--device", options.device.selector, "SELECTOR",
           "OpenCL device: platform:device, index, cpu, gpu or a part of its name; all, or several "
           "separated by commas; /N splits it into N sub-devices, =N uses only N of its compute "
           "units; default: the environment variable PHOTILE_DEVICE, otherwise the best");
  add_run_group(command, options);
}

void add_picture_settings(CLI::App& command, RenderOptions& options, const Settings& more) {
  add_quality_preset(command, options.quality_options());  // before the settings that override it
  add_setting_options(command, options, {}, more);
  const OptionGroup picture(command, "Picture");
  add_view_options(picture, options);
  picture.add("--size", options.size, "WxH",
              fmt::format("width and height, pixels; default: {} high with the camera's aspect "
                          "ratio, otherwise {}x{}",
                          defaults::image_height, defaults::image_width, defaults::image_height),
              picture_size());
}

void add_integrator_option(CLI::App& command, RenderOptions& options) {
  OptionGroup(command, "Picture")
      .choose(
          "--integrator", all_integrators, options.integrator,
          "photon maps, or path tracing from the eye: unbiased, slower, without an OpenCL device",
          [&options](Integrator integrator) { options.integrator = integrator; });
}

void add_projection_options(const OptionGroup& picture, RenderOptions& options) {
  picture.choose("--projection", all_projections, Projection::perspective,
                 "projection: Radiance's -vtv, -vth and -vta, the whole sphere, -vtl",
                 [&options](Projection projection) { options.projection = projection; });
  picture.add("--field-of-view", options.field_of_view, "X",
              fmt::format("vertical field of view, degrees, or metres with orthographic; default: "
                          "the camera's, {} with fisheyes, {} with orthographic",
                          defaults::fisheye_field_of_view, defaults::orthographic_height),
              positive_number());
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  add_picture_options(command, options.pictures);
  const OptionGroup output(command, "Output"), picture(command, "Picture");
  add_scale_option(output, options.pictures.false_colour);
  set_quality(options.quality_options(), Quality::good);
  add_goal_options(command, options.goal);
  Settings more = display_settings(options.pictures);
  for (Setting& setting : glare_settings(options.glare_limit)) more.push_back(setting);
  add_picture_settings(command, options, more);
  add_projection_options(picture, options);
  add_integrator_option(command, options);
  OptionGroup(command, "Run")
      .add("--stats", options.statistics, "FILE", "write the summary as JSON");
  add_saved_maps_options(command, options);
  OptionGroup(command, "Quality")
      .add("--errors", options.errors, "FILE.exr",
           "standard errors of the picture, one layer per light: the noise of nodes and samples",
           file_ending_in({".exr"}));
  picture
      .add("--denoise", options.denoiser, "[LIBRARY]",
           "denoise each light's layer by an installed Open Image Denoise 2; illuminance is never "
           "denoised")
      ->expected(0, 1)
      ->default_str(defaults::denoising_library);
  output.add("--glare", options.glare, "FILE.png",
             "picture that marks reflections above a limit, one colour per light",
             file_ending_in({".png"}));
}

void add_saved_maps_options(CLI::App& command, RenderOptions& options) {
  const OptionGroup photons(command, "Photons");
  CLI::Option* save =
      photons.add("--save-maps", options.save_maps, "FILE", "save the photons for --load-maps");
  photons
      .add("--load-maps", options.load_maps, "FILE",
           "load photons that --save-maps saved, of the same scene and options")
      ->excludes(save);
}

const char* name_of(Integrator integrator) {
  return integrator == Integrator::path ? "path" : "photon-map";
}

void share_rendering(RenderOptions& options) {
  options.parameters.processes = processes();
  const auto refuse = [](bool asked, const char* what) {
    if (asked) refuse_several(what, "leave it out, or start one process");
  };
  refuse(options.integrator == Integrator::path, "--integrator path");
  refuse(!options.save_maps.empty(), "--save-maps");
  refuse(!options.load_maps.empty(), "--load-maps");
  for (const GoalOption& goal : goal_options()) {
    if (options.goal.*goal.value > 0) {
      refuse_several(fmt::format("--{}", goal.option), "leave it out, or start one process");
    }
  }
}

void refuse_photon_map_options(const CLI::App& command) {
  const std::set<std::string> groups{"Photons", "Estimate", "Device", "Quality"};
  for (const std::string& name : names_set(command)) {
    if (!is_of_photon_maps(name)) continue;
    throw UsageError(fmt::format(
        "--set {}: only photon maps use it; leave out either this or --integrator path", name));
  }
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || groups.count(option->get_group()) == 0) continue;
    throw UsageError(
        fmt::format("{}: only photon maps use it; leave out either this or --integrator path",
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

Camera camera_of(const Scene& scene, const RenderOptions& options) {
  const Camera chosen = ends_in(options.camera, ".vf")
                            ? in_scene(scene, reading::read_radiance_view(options.camera))
                            : choose_camera(scene, options.camera);
  if (options.eye.empty() && options.look_at.empty()) return chosen;
  const Camera from = in_world(scene, chosen);
  const auto point = [](const std::vector<double>& given, const glm::dvec3& otherwise) {
    return given.empty() ? otherwise : glm::dvec3(given[0], given[1], given[2]);
  };
  const glm::dvec3 eye = point(options.eye, from.position);
  const glm::dvec3 target = point(options.look_at, eye + from.forward);
  if (!(glm::distance(eye, target) > 0)) {
    throw UsageError(fmt::format(
        "--look-at {:g},{:g},{:g}: the camera stands there; give another point or --eye", target.x,
        target.y, target.z));
  }
  const glm::dvec3 up = direction_in_world(scene, {0, 1, 0});
  Camera camera = Camera::look_at(eye, target, up, from.vertical_field_of_view);
  camera.name = from.name;
  camera.aspect_ratio = from.aspect_ratio;
  return in_scene(scene, camera);
}

Camera opening_camera(const Scene& scene, const RenderOptions& options) {
  Camera camera = camera_of(scene, options);
  if (camera.projection != Projection::perspective) return publish::opening_camera(scene);
  if (!options.eye.empty() || !options.look_at.empty()) camera.name.clear();  // of no camera
  return camera;
}

Camera projected(Camera camera, const RenderOptions& options) {
  if (options.projection) camera.projection = *options.projection;
  const Projection projection = camera.projection;
  const bool round = options.projection &&
                     (projection == Projection::fisheye || projection == Projection::angular);
  if (round) camera.aspect_ratio = 1;
  if (projection == Projection::equirectangular) camera.aspect_ratio = 2;
  if (projection == Projection::orthographic) {
    if (options.field_of_view > limits::max_coordinate) {
      throw UsageError(fmt::format("--field-of-view {:g}: is more than {:g} m",
                                   options.field_of_view, limits::max_coordinate));
    }
    if (options.field_of_view > 0) camera.orthographic_height = options.field_of_view;
    return camera;
  }
  double degrees = options.field_of_view;
  if (!(degrees > 0) && round) degrees = defaults::fisheye_field_of_view;
  if (!(degrees > 0)) return camera;
  const double most = projection == Projection::angular       ? 360.0
                      : projection == Projection::perspective ? 179.0
                                                              : 180.0;
  if (degrees > most) {
    throw UsageError(fmt::format("--field-of-view {:g}: is more than the {:g} degrees of a {} view",
                                 degrees, most, name_of(projection)));
  }
  camera.vertical_field_of_view = glm::radians(degrees);
  return camera;
}

LightMix mix_of(const Scene& scene, const RenderOptions& options) {
  LightMix mix = LightMix::of(scene, options.load.lumen_per_watt);
  change_lights(mix, joined(changes_of(options.mood, mix, options.scene), options.lights));
  return mix;
}

void set_film_size(Film& film, const std::string& size, const Camera& camera) {
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
