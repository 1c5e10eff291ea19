#include "tools/command/saved_maps_option.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "photile/scene_renderer.hpp"
#include "saved_maps/saved_maps.hpp"
#include "tools/command/version.hpp"

namespace photile::app {
namespace {

/// What photons and groups depend on beside the scene, in words that a refusal can name.
std::string settings_of(const RenderOptions& options) {
  const RenderParameters& parameters = options.parameters;
  const std::string radius =
      parameters.radius > 0 ? fmt::format("radius {} m", parameters.radius)
                            : fmt::format("k {}", parameters.neighbours);  // the radius follows it
  const bool global = parameters.structure == MapStructure::kdtree_global;
  return fmt::format("photile {}, {} photons, quota {}, seed {}, {}, angle {}, maps {}{}{}",
                     version_number(), parameters.photons.emitted_photons, options.quota,
                     parameters.photons.seed, radius, parameters.angle_degrees, options.maps,
                     global ? ", one tree" : "",
                     parameters.film.direct_rays > 0 ? ", direct rays" : "");
}

}  // namespace

std::optional<PreparedPhotons> load_maps(const Scene& scene, const RenderOptions& options,
                                         Progress& progress) {
  if (options.load_maps.empty()) return std::nullopt;
  progress.begin("load photons", 0, "");
  PreparedPhotons prepared = saved_maps::load(options.load_maps, scene, settings_of(options));
  progress.end();
  return prepared;
}

KeepPhotons keep_maps(const Scene& scene, const RenderOptions& options, Progress& progress) {
  if (options.save_maps.empty()) return {};
  return [&scene, &progress, file = options.save_maps,
          settings = settings_of(options)](const PreparedPhotons& photons) {
    progress.begin("save photons", 0, "");
    saved_maps::save(file, scene, settings, photons);
    progress.end();
  };
}

RenderResult render_with_kept_maps(const Scene& scene, const Camera& camera, const HitSource& hits,
                                   std::span<Device> devices, const RenderOptions& options,
                                   LightLayers* reflections, Progress& progress) {
  std::optional<PreparedPhotons> prepared = load_maps(scene, options, progress);
  SceneRenderer renderer(scene, devices, options.parameters, prepared ? &*prepared : nullptr,
                         keep_maps(scene, options, progress), progress);
  RenderResult result = renderer.render(hits, options.parameters.film, progress);
  if (!reflections) return result;
  RenderResult reflected = renderer.render_reflections(camera, options.parameters.film, progress);
  *reflections = std::move(reflected.layers);
  return result;
}

}  // namespace photile::app
