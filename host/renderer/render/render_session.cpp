#include "render/render_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "photile/sensors.hpp"
#include "render/hit_source.hpp"
#include "render/picture.hpp"
#include "render/setting.hpp"
#include "trace/sensors.hpp"

namespace photile {

namespace {

/// Errors: UsageError and SettingError where the passes cannot be kept, or not from these photons.
void check_kept(const RenderPlan& plan, const TracedPhotons* prepared, bool keeps) {
  if (plan.used().processes && (prepared || keeps)) {
    throw UsageError(
        "saved maps are of one process; leave them out where several share a rendering");
  }
  if (prepared && !prepared->caustics && plan.keeps_caustics()) {
    throw SettingError(
        setting_named("light_map_rays"),
        "rays that gather take caustics from photons of their own, which these saved maps lack; "
        "save them again with rays that gather");
  }
  if (!plan.may_keep_passes()) {
    throw SettingError(
        setting_named("passes"),
        fmt::format(
            "{} photon passes: walks, views, saved maps and glare need all "
            "photons in memory at once; take fewer photons, or give a number of passes where "
            "more memory may be had",
            plan.passes()));
  }
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene) : rays(scene) {
  cost.add(stopwatch.taken(), rays.bytes());
}

void require_device(std::span<const Device> devices) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
}

RenderSession::RenderSession(std::shared_ptr<const PreparedScene> scene, std::span<Device> devices,
                             const RenderParameters& parameters, TracedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress)
    : scene_(std::move(scene)),
      devices_(devices),
      plan_(parameters, scene_->rays, HitsAsk::pictures, progress),
      photons_(scene_->rays, devices, plan_, costs_) {
  require_device(devices);
  check_kept(plan_, prepared, static_cast<bool>(keep));
  costs_.structure = scene_->cost;
  for (int pass = 0; pass < plan_.passes(); ++pass) {
    const bool first = pass == 0;
    passes_.push_back(std::make_unique<PassLight>(
        scene_->rays, plan_,
        photons_.next(first ? prepared : nullptr, first && keep ? &keep : nullptr, progress)));
  }
  if (reads_light_maps()) {
    frames_.emplace(scene_->rays, light().cache()->maps());
  }
}

RenderResult RenderSession::render(const HitSource& hits, const Film& film, Progress& progress,
                                   const LayerMixdown* mixdown) {
  // The time of growing light maps is spread over all of their pictures.
  if (parts_ == 1) costs_.start_picture();
  Picture picture(scene_->rays, plan_, devices_, film, plan_.passes(), mixdown, costs_);
  for (const auto& pass : passes_) picture.add(hits, *pass, progress);
  RenderResult result = picture.finish(photons_.radius());
  if (parts_ > 1) {
    // Each round has its own radius, unless one was asked for.
    const Film made = result.used.film;
    result.used = of_parts(plan_.used(), parts_);
    result.used.film = made;
  }
  return result;
}

void RenderSession::grow(int parts, Progress& progress) {
  const int photons_before = photons_of_parts(parts_);
  parts_ += parts;
  const int more_photons = photons_of_parts(parts_) - photons_before;
  frames_.reset();
  costs_.light_map_nodes = 0;
  if (more_photons == 0) {
    light().grow(parts_);
  } else {
    Growth growth{parts_, light().take_points()};
    passes_.clear();  // before other maps take its room
    passes_.push_back(std::make_unique<PassLight>(
        scene_->rays, plan_, photons_.next(nullptr, nullptr, progress, more_photons),
        std::move(growth)));
  }
  frames_.emplace(scene_->rays, light().cache()->maps());
}

std::optional<LightMapContents> RenderSession::light_map_contents() const {
  if (!reads_light_maps()) return std::nullopt;
  const cache::LightMaps& maps = passes_.front()->cache()->maps();
  if (maps.statistics().nodes == 0) return std::nullopt;
  LightMapContents contents = maps.contents();
  contents.settings = photons_.light_map_settings();
  return contents;
}

namespace {

/// The picture of light maps that grow.
RenderResult render_grown(const std::shared_ptr<const PreparedScene>& scene, const HitSource& hits,
                          Film film, std::span<Device> devices, const RenderParameters& parameters,
                          Progress& progress) {
  RenderParameters part = parameters;
  part.film = film;
  RenderSession session(scene, devices, part_of(part), nullptr, {}, progress);
  RenderResult result = session.render(hits, session.film(), progress);
  for_later_rounds(parameters.passes, [&](int parts) {
    session.grow(parts, progress);
    result = session.render(hits, session.film(), progress);
  });
  return result;
}

}  // namespace

RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress) {
  require_device(devices);
  const auto prepared = std::make_shared<const PreparedScene>(scene);
  if (grows(parameters)) return render_grown(prepared, hits, film, devices, parameters, progress);
  const RenderPlan plan(parameters, prepared->rays,
                        hits.dense() ? HitsAsk::pictures : HitsAsk::points, progress);
  RenderCosts costs;
  costs.structure = prepared->cost;
  Picture picture(prepared->rays, plan, devices, film, plan.passes(), nullptr, costs);
  std::optional<PhotonPasses> photons(std::in_place, prepared->rays, devices, plan, costs);
  std::unique_ptr<PassLight> light;
  for (int pass = 0; pass < plan.passes(); ++pass) {
    light.reset();  // before the maps of the next pass take its room
    light = std::make_unique<PassLight>(prepared->rays, plan,
                                        photons->next(nullptr, nullptr, progress));
    picture.add(hits, *light, progress);
  }
  const double radius = photons->radius();
  const Stopwatch release_watch;
  light.reset();
  photons.reset();
  costs.release.add(release_watch.taken());
  return picture.finish(radius);
}

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, CameraHits(camera), parameters.film, devices, parameters, progress);
}

RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress) {
  return render(scene, camera, std::span(&device, 1), parameters, progress);
}

struct SceneRenderer::Impl : RenderSession {
  using RenderSession::RenderSession;
};

SceneRenderer::SceneRenderer(const Scene& scene, std::span<Device> devices,
                             const RenderParameters& parameters, TracedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress)
    : impl_(std::make_unique<Impl>(std::make_shared<const PreparedScene>(scene), devices,
                                   parameters, prepared, keep, progress)) {}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const Film& film, Progress& progress,
                                   const LayerMixdown* mixdown) {
  return impl_->render(CameraHits(camera), film, progress, mixdown);
}

DrawnFrame SceneRenderer::draw(const Camera& camera, const Film& film,
                               std::span<const glm::vec3> powers, const FrameFilling& filling,
                               std::span<glm::vec3> picture, Progress& progress,
                               SceneRenderer* coarser) {
  return impl_->frames().draw(camera, film, powers, filling, picture, progress,
                              coarser ? &coarser->impl_->frames() : nullptr);
}

void SceneRenderer::bound_light_maps(std::uint64_t bytes) {
  if (draws()) impl_->frames().bound(bytes);
}

bool SceneRenderer::draws() const { return impl_->reads_light_maps(); }

std::optional<LightMapContents> SceneRenderer::light_maps() const {
  return impl_->light_map_contents();
}

RenderResult SceneRenderer::render_reflections(const Camera& camera, const Film& film,
                                               Progress& progress, const LayerMixdown* mixdown) {
  return impl_->render(ReflectedHits(camera), film, progress, mixdown);
}

namespace {

Film film_of(std::span<const Sensor> sensors, const GatherParameters& gathering) {
  if (gathering.rays < 1 || gathering.rays > limits::max_samples_per_pixel) {
    throw UsageError("rays: " + std::to_string(gathering.rays) + " is not between 1 and " +
                     std::to_string(limits::max_samples_per_pixel));
  }
  if (sensors.empty() || sensors.size() > limits::max_sensors) {
    throw UsageError("sensors: " + std::to_string(sensors.size()) + " is not between 1 and " +
                     std::to_string(limits::max_sensors));
  }
  return {1, static_cast<int>(sensors.size()), gathering.rays};
}

/// Replaces the illuminance of the film, which is that of the surfaces seen, by that of the
/// sensors.
LightLayers with_own_illuminance(LightLayers layers) {
  const auto own = [](const glm::vec3& radiance) {
    return static_cast<float>(glm::pi<double>() * luminance(glm::dvec3(radiance)));
  };
  for (LightLayers::Layer& layer : layers.layers) {
    std::transform(layer.radiance.begin(), layer.radiance.end(), layer.illuminance.begin(), own);
  }
  for (LightLayers::Row& row : layers.rows) {
    std::transform(row.radiance.begin(), row.radiance.end(), row.illuminance.begin(), own);
  }
  return layers;
}

}  // namespace

PrimaryHitBatch GatherHits::trace(const RayScene& rays, const PrimaryHitParameters& film,
                                  int first_row, int last_row,
                                  std::span<const std::uint32_t> map_of) const {
  return trace::gather_rays(rays, sensors_, response_, light_sampler_,
                            finds_hot_spots_ == FindsHotSpots::yes, film, first_row, last_row,
                            map_of);
}

RenderResult gather(const Scene& scene, std::span<const Sensor> sensors,
                    const GatherParameters& gathering, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  RenderResult result =
      render_hits(scene, GatherHits(scene, sensors, gathering.response, FindsHotSpots::yes),
                  film_of(sensors, gathering), devices, parameters, progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

PathTracerResult gather_by_paths(const Scene& scene, std::span<const Sensor> sensors,
                                 const GatherParameters& gathering, std::uint64_t seed,
                                 Progress& progress) {
  PathTracerResult result =
      trace_paths_of_hits(scene, GatherHits(scene, sensors, gathering.response, FindsHotSpots::no),
                          eye_rays({.seed = seed, .film = film_of(sensors, gathering)}), progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

}  // namespace photile
