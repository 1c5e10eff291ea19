#include "command/saved_maps_option.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "command/command_line.hpp"
#include "render/render_costs.hpp"
#include "render/render_session.hpp"
#include "render/setting.hpp"

namespace photile::app {
namespace {

/// Adds to `time` what `work` takes, and returns what it does.
template <class Work>
auto timed(TimeTaken& time, const Work& work) {
  struct Clock {
    ~Clock() { time += stopwatch.taken(); }
    TimeTaken& time;
    Stopwatch stopwatch;
  };
  const Clock clock{time, {}};
  return work();
}

}  // namespace

saved_maps::Settings saved_settings(const RenderParameters& parameters) {
  return {fmt::format("photile {}, {}", version_number(), photon_settings(parameters)),
          group_settings(parameters)};
}

std::optional<TracedPhotons> load_maps(const Scene& scene, const RenderOptions& options,
                                       Progress& progress) {
  if (options.parameters.passes > 1 && !(options.load_maps.empty() && options.save_maps.empty())) {
    throw SettingError(setting_named("passes"),
                       "saved maps hold the photons of one pass; leave out passes");
  }
  if (options.load_maps.empty()) return std::nullopt;
  progress.begin("load photons", 0, "");
  TracedPhotons prepared =
      saved_maps::load(options.load_maps, scene, saved_settings(options.parameters));
  progress.end();
  return prepared;
}

KeepPhotons keep_maps(const Scene& scene, const RenderOptions& options, Progress& progress) {
  if (options.save_maps.empty()) return {};
  return [&scene, &progress, file = options.save_maps,
          settings = saved_settings(options.parameters)](const TracedPhotons& photons) {
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
  TimeTaken loading, keeping, reflecting;
  std::optional<TracedPhotons> prepared =
      timed(loading, [&] { return load_maps(scene, options, progress); });
  KeepPhotons keep = keep_maps(scene, options, progress);
  if (keep) {
    keep = [&keeping, save = std::move(keep)](const TracedPhotons& photons) {
      timed(keeping, [&] { save(photons); });
    };
  }
  auto maps = std::make_unique<RenderSession>(std::make_shared<const PreparedScene>(scene), devices,
                                              options.parameters, progress);
  maps->keep_passes(prepared ? &*prepared : nullptr, keep, progress);
  RenderResult result = maps->render(hits, options.parameters.film, progress);
  timed(keeping, [&] { keep_light_maps(maps->light_map_contents(), options, progress); });
  if (reflections) {
    timed(reflecting, [&] {
      *reflections = maps->render(reflected_hits(camera), options.parameters.film, progress).layers;
    });
  }
  TimeTaken releasing;
  timed(releasing, [&] { maps.reset(); });
  if (!options.load_maps.empty()) add_time(result.statistics, "load photons", loading);
  if (!options.save_maps.empty()) add_time(result.statistics, "save photons", keeping);
  if (reflections) add_time(result.statistics, "reflections", reflecting);
  add_time(result.statistics, "release memory", releasing);
  return result;
}

}  // namespace photile::app
