#include "app/saved_maps_option.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "app/version.hpp"
#include "photile/scene_renderer.hpp"
#include "saved_maps/saved_maps.hpp"

namespace photile::app {
namespace {

/// What photons and groups depend on beside the scene, in words that a refusal can name.
std::string settings_of(const RenderOptions& options) {
  const RenderParameters& parameters = options.parameters;
  const std::string radius =
      parameters.radius > 0 ? fmt::format("radius {} m", parameters.radius)
                            : fmt::format("k {}", parameters.neighbours);  // the radius follows it
  const bool global = parameters.structure == MapStructure::kdtree_global;
  return fmt::format("photile {}, {} photons, quota {}, seed {}, {}, angle {}, maps {}{}",
                     version_number(), parameters.photons.emitted_photons, options.quota,
                     parameters.photons.seed, radius, parameters.angle_degrees, options.maps,
                     global ? ", one tree" : "");
}

}  // namespace

RenderResult render_with_saved_maps(const Scene& scene, const Camera& camera,
                                    std::span<Device> devices, const RenderOptions& options,
                                    Progress& progress) {
  const std::string settings = settings_of(options);
  std::optional<PreparedPhotons> prepared;
  KeepPhotons keep;
  if (!options.load_maps.empty()) {
    progress.begin("load photons", 0, "");
    prepared = saved_maps::load(options.load_maps, scene, settings);
    progress.end();
  } else {
    keep = [&](const PreparedPhotons& photons) {
      progress.begin("save photons", 0, "");
      saved_maps::save(options.save_maps, scene, settings, photons);
      progress.end();
    };
  }
  SceneRenderer renderer(scene, devices, options.parameters, prepared ? &*prepared : nullptr, keep,
                         progress);
  return renderer.render(camera, options.parameters.film, progress);
}

}  // namespace photile::app
