#include "tools/command/saved_maps_option.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "render/kept_maps.hpp"
#include "render/setting.hpp"
#include "saved_maps/saved_maps.hpp"
#include "tools/command/version.hpp"

namespace photile::app {
namespace {

std::string settings_of(const RenderOptions& options) {
  return fmt::format("photile {}, {}", version_number(), photon_settings(options.parameters));
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

void keep_light_maps(const std::optional<LightMapContents>& light_maps,
                     const RenderOptions& options, Progress& progress) {
  if (options.save_maps.empty() || !light_maps) return;
  progress.begin("save light maps", 0, "");
  saved_maps::add_light_maps(options.save_maps, *light_maps);
  progress.end();
}

RenderResult render_with_kept_maps(const Scene& scene, const Camera& camera, const HitSource& hits,
                                   std::span<Device> devices, const RenderOptions& options,
                                   LightLayers* reflections, Progress& progress) {
  std::optional<PreparedPhotons> prepared = load_maps(scene, options, progress);
  KeptMaps maps(scene, devices, options.parameters, prepared ? &*prepared : nullptr,
                keep_maps(scene, options, progress), progress);
  RenderResult result = maps.render(hits, options.parameters.film, progress);
  keep_light_maps(maps.light_map_contents(), options, progress);
  if (!reflections) return result;
  RenderResult reflected = maps.render(ReflectedHits(camera), options.parameters.film, progress);
  *reflections = std::move(reflected.layers);
  return result;
}

}  // namespace photile::app
