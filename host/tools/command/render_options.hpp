// The options of `photile render`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/defaults.hpp"
#include "photile/device.hpp"
#include "photile/light_mix.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "tools/command/picture_outputs.hpp"
#include "tools/trade/quality_target.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// What estimates the light that reaches a surface.
enum class Integrator { photon_map, path };

/// As typed, checked against the limits.
struct RenderOptions {
  std::string scene;
  PictureOptions pictures;
  RenderParameters parameters;
  std::string integrator = "photon-map";  ///< or "path"
  Integrator integrates = Integrator::photon_map;
  std::string quota;               ///< "balanced", "power" or "equal"
  std::string maps;                ///< "naive", "triangle", "patch" or "auto"
  std::string area;                ///< "disc" or "clipped"
  std::string kernel;              ///< "constant", "cone" or "epanechnikov"
  std::string direct = "photons";  ///< or "rays": what brings the light straight from lamps
  bool own_direct = false;         ///< given by the user
  int direct_rays = defaults::direct_rays;
  std::string structure;              ///< "uniform-grid", ...
  QualityTarget target;               ///< settings are chosen to meet it
  bool tuned = false;                 ///< use the tuning that `photile devices --tune` stored
  bool own_photons_per_cell = false;  ///< given by the user: a tuning does not replace it
  std::string camera;
  std::string size;                        ///< "" = by the camera
  std::vector<std::string> lights;         ///< what --light asks for
  std::vector<LightChange> light_changes;  ///< the same, understood
  DeviceOptions device;
  bool no_cache = false;
  SceneLoadOptions load;
  int threads = 0;
  std::string statistics;            ///< file, "" = none
  std::string save_maps, load_maps;  ///< files, "" = none
  std::string preview;               ///< HOST:PORT of a tev; "" = none
  std::string glare;                 ///< PNG of marked reflections, "" = none
  double glare_limit = defaults::glare_limit;
  bool quiet = false;
};

/// Adds the options of `photile render` to the subcommand.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Adds those that say what is rendered and how, but not what becomes of the picture: what commands
/// that render for another purpose take, too.
void add_setting_options(CLI::App& command, RenderOptions& options);

/// Adds those of them that say how light is found, but not what a camera makes of it.
void add_light_setting_options(CLI::App& command, RenderOptions& options);

/// Adds --save-maps and --load-maps.
void add_saved_maps_options(CLI::App& command, RenderOptions& options);

/// Adds --preview.
void add_preview_option(CLI::App& command, RenderOptions& options, const std::string& group);

/// Adds --integrator.
void add_integrator_option(CLI::App& command, RenderOptions& options);

/// Sets what `options` holds as words: the integrator, the quota, the maps, the structure, the
/// area, the light changes and the cache. Errors: UsageError for a light change that is not
/// understood, and for --final-gather with --direct photons; CLI11 has checked the other words.
void apply_words(RenderOptions& options);

/// Errors: UsageError that names an option which was given to `command` although the path tracer
/// has no use for it.
void refuse_photon_map_options(const CLI::App& command);

/// The camera named by `selector`: a name, an index, or "" for the first.
/// Errors: UsageError listing those there are.
const Camera& choose_camera(const Scene& scene, const std::string& selector);

/// The scene's lights as they are, then as --light asks for.
/// Errors: UsageError where no light has the name.
LightMix mix_of(const Scene& scene, const RenderOptions& options);

/// Width and height into `film`: `size` if given, else the default height and the camera's aspect
/// ratio, else the default size. Errors: UsageError when the aspect ratio makes the picture too
/// wide.
void set_film_size(PrimaryHitParameters& film, const std::string& size, const Camera& camera);

}  // namespace photile::app
