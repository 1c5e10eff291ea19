// The options of `photile render`.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/quality_options.hpp"
#include "command/scene_options.hpp"
#include "command/setting_options.hpp"
#include "photile/camera.hpp"
#include "photile/communicator.hpp"
#include "photile/defaults.hpp"
#include "photile/device.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// The method that computes the light that reaches a surface.
enum class Integrator { photon_map, path };

/// The options as typed; each value is within its range.
struct RenderOptions {
  QualityOptions quality_options() { return {quality, parameters}; }

  std::string scene;
  PictureOptions pictures;
  RenderParameters parameters;
  Integrator integrator = Integrator::photon_map;
  Quality quality = Quality::draft;  ///< its settings, except those that are given
  RefinementGoal goal;               ///< pictures are made until it is met
  std::string camera;
  std::vector<double> eye, look_at;      ///< points in the file's world; empty = by the camera
  std::string size;                      ///< "" = by the camera
  std::optional<Projection> projection;  ///< none = the camera's
  double field_of_view = 0;              ///< degrees, or metres of parallel rays; 0 = by the camera
  std::vector<LightChange> lights;       ///< those of --light
  MoodOptions mood;                      ///< before them
  DeviceOptions device;
  SceneLoadOptions load;
  int threads = 0;
  std::string statistics;            ///< file, "" = none
  std::string save_maps, load_maps;  ///< files, "" = none
  std::string errors;                ///< EXR of standard errors, "" = none
  std::string denoiser;              ///< library of Open Image Denoise, "" = not denoised
  std::string glare;                 ///< PNG of marked reflections, "" = none
  double glare_limit = defaults::glare_limit;
  bool quiet = false;
};

/// Adds the options of `photile render` to the subcommand.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Adds those of the computation of light, but not those of the camera: commands that measure take
/// them, too.
///   without   names of settings that the command does without
///   more      that --set reaches, too
void add_setting_options(CLI::App& command, RenderOptions& options,
                         std::initializer_list<std::string_view> without = {},
                         const Settings& more = {});

/// Adds --camera, --eye and --look-at.
void add_view_options(const OptionGroup& picture, RenderOptions& options);

/// Adds these and those of the camera, but not those of outputs.
void add_picture_settings(CLI::App& command, RenderOptions& options, const Settings& more = {});

/// Adds --threads and --quiet.
void add_run_group(CLI::App& command, RenderOptions& options);

/// Adds --save-maps and --load-maps.
void add_saved_maps_options(CLI::App& command, RenderOptions& options);

/// Adds --integrator.
void add_integrator_option(CLI::App& command, RenderOptions& options);

/// "photon-map", "path".
const char* name_of(Integrator integrator);

/// Shares the rendering among the processes that were started together. Errors: UsageError for what
/// one process alone can do.
void share_rendering(RenderOptions& options);

/// Errors: UsageError that names an option which was given to `command` although the path tracer
/// has no use for it.
void refuse_photon_map_options(const CLI::App& command);

/// The camera named by `selector`: a name, an index, or "" for the first.
/// Errors: UsageError listing those there are.
const Camera& choose_camera(const Scene& scene, const std::string& selector);

/// The camera that --camera names, moved to --eye and turned to --look-at, upright.
/// Errors: those of choose_camera; UsageError where it would look at its own position.
Camera camera_of(const Scene& scene, const RenderOptions& options);

/// The same, or where it has no perspective the first that has, if any: pages have a perspective.
Camera opening_camera(const Scene& scene, const RenderOptions& options);

/// The camera with the projection and the field of view that are asked for. Errors: UsageError for
/// an angle that the projection cannot have.
Camera projected(Camera camera, const RenderOptions& options);

/// The scene's lights as they are, changed by --mood and --light. Errors: UsageError where no light
/// has the name; those of changes_of.
LightMix mix_of(const Scene& scene, const RenderOptions& options);

/// Width and height into `film`: `size` if given, else the default height and the camera's aspect
/// ratio, else the default size. Errors: UsageError when the aspect ratio makes the picture too
/// wide.
void set_film_size(Film& film, const std::string& size, const Camera& camera);

}  // namespace photile::app
