#include "render/render_session.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/hit_source.hpp"
#include "render/picture.hpp"
#include "render/quality.hpp"
#include "render/refinement.hpp"
#include "render/setting.hpp"

namespace photile {
namespace {

/// Errors: UsageError and SettingError where the passes cannot be kept, or not from these photons.
void check_kept(const RenderPlan& plan, const TracedPhotons* prepared, bool keeps) {
  if (plan.used().processes && (prepared || keeps)) {
    throw UsageError("saved maps work only with one process; leave them out, or start one process");
  }
  if (prepared && !prepared->caustics && plan.gathers_at_nodes()) {
    throw SettingError(setting_named("light_map_rays"),
                       "gathering rays need separate photons for caustics, which these saved maps "
                       "lack; save them again with light_map_rays above 0");
  }
  if (!plan.may_keep_passes()) {
    throw SettingError(
        setting_named("passes"),
        fmt::format("{} photon passes: walks, views, saved maps and glare need all photons in "
                    "memory at once; use fewer photons, or passes=1 if more memory may be used",
                    plan.passes()));
  }
}

std::span<Device> some_of(std::span<Device> devices) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
  return devices;
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene) : rays(scene) {
  cost.add(stopwatch.taken(), rays.bytes());
}

RenderSession::RenderSession(std::shared_ptr<const PreparedScene> scene, std::span<Device> devices,
                             const RenderParameters& parameters, Progress& progress, HitsAsk hits)
    : scene_(std::move(scene)),
      devices_(some_of(devices)),
      plan_(parameters, scene_->rays, hits, progress) {
  costs_.structure = scene_->cost;
}

void RenderSession::keep_passes(TracedPhotons* prepared, const KeepPhotons& keep,
                                Progress& progress) {
  check_kept(plan_, prepared, static_cast<bool>(keep));
  photons_.emplace(scene_->rays, devices_, plan_, costs_);
  for (int pass = 0; pass < plan_.passes(); ++pass) {
    const bool first = pass == 0;
    passes_.push_back(std::make_unique<PassLight>(
        scene_->rays, plan_,
        photons_->next(first ? prepared : nullptr, first && keep ? &keep : nullptr, progress)));
  }
  set_frames();
}

void RenderSession::set_frames() {
  if (!reads_light_maps()) return;
  frames_.emplace(scene_->rays, light().cache()->maps());
}

RenderResult RenderSession::render(const HitSource& hits, const Film& film, Progress& progress,
                                   const LayerMixdown* mixdown) {
  // The time of light maps that parts were added to is spread over all of their pictures.
  if (parts_ <= 1) costs_.start_picture();
  Picture picture(scene_->rays, plan_, devices_, film, plan_.passes(), mixdown, costs_);
  const bool kept = !passes_.empty();
  if (!kept) photons_.emplace(scene_->rays, devices_, plan_, costs_);
  for (std::size_t pass = 0; pass < static_cast<std::size_t>(plan_.passes()); ++pass) {
    if (!kept) {
      passes_.clear();  // before the maps of the next pass take its room
      passes_.push_back(std::make_unique<PassLight>(scene_->rays, plan_,
                                                    photons_->next(nullptr, nullptr, progress)));
    }
    picture.add(hits, kept ? *passes_[pass] : *passes_.back(), progress);
  }
  const double radius = photons_->radius();
  if (!kept) {
    const Stopwatch release_watch;
    passes_.clear();
    photons_.reset();
    costs_.release.add(release_watch.taken());
  }
  RenderResult result = picture.finish(radius);
  if (parts_ > 1) {
    // The photons of each number of parts have their own radius, unless one was asked for.
    const Film made = result.used.film;
    result.used = of_parts(plan_.used(), parts_);
    result.used.film = made;
  }
  return result;
}

void RenderSession::add_parts(int parts, Progress& progress) {
  const int before = std::exchange(parts_, parts_ + parts);
  if (before == 0) return keep_passes(nullptr, {}, progress);
  const int more_photons = photons_of_parts(parts_) - photons_of_parts(before);
  frames_.reset();
  costs_.light_map_nodes = 0;
  cache::GatheredPoints points = light().take_points();
  if (more_photons == 0) {
    light().make_light(parts_, std::move(points));
  } else {
    passes_.clear();  // before other maps take its room
    passes_.push_back(std::make_unique<PassLight>(
        scene_->rays, plan_, photons_->next(nullptr, nullptr, progress, more_photons), parts_,
        std::move(points)));
  }
  set_frames();
}

std::optional<LightMapContents> RenderSession::light_map_contents() const {
  if (!reads_light_maps()) return std::nullopt;
  const cache::LightMaps& maps = passes_.front()->cache()->maps();
  if (maps.statistics().nodes == 0) return std::nullopt;
  LightMapContents contents = maps.contents();
  contents.settings = photons_->light_map_settings();
  return contents;
}

RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress) {
  const auto prepared = std::make_shared<const PreparedScene>(scene);
  if (!in_parts(parameters)) {
    return RenderSession(prepared, devices, parameters, progress,
                         hits.dense ? HitsAsk::pictures : HitsAsk::points)
        .render(hits, film, progress);
  }
  RenderParameters all = parameters;
  all.film = film;
  RenderSession session(prepared, devices, part_of(all), progress);
  RenderResult result;
  refine({.parts = parameters.passes},
         {.add =
              [&](int parts, Progress& deadline) {
                session.add_parts(parts, deadline);
                result = session.render(hits, session.film(), deadline);
                return result.standard_error;
              }},
         progress);
  return result;
}

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, camera_hits(camera), parameters.film, devices, parameters, progress);
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
                                   parameters, progress)) {
  impl_->keep_passes(prepared, keep, progress);
}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const Film& film, Progress& progress,
                                   const LayerMixdown* mixdown) {
  return impl_->render(camera_hits(camera), film, progress, mixdown);
}

DrawnFrame SceneRenderer::draw(const Camera& camera, const Film& film,
                               std::span<const glm::vec3> powers, const FrameFilling& filling,
                               std::span<glm::vec3> picture, Progress& progress,
                               SceneRenderer* coarser) {
  return impl_->frames().draw(camera, film, powers, filling, picture, progress,
                              coarser ? &coarser->impl_->frames().view() : nullptr);
}

void SceneRenderer::bound_light_maps(std::uint64_t bytes) {
  if (draws()) impl_->frames().view().bound(bytes);
}

bool SceneRenderer::draws() const { return impl_->reads_light_maps(); }

std::optional<LightMapContents> SceneRenderer::light_maps() const {
  return impl_->light_map_contents();
}

RenderResult SceneRenderer::render_reflections(const Camera& camera, const Film& film,
                                               Progress& progress, const LayerMixdown* mixdown) {
  return impl_->render(reflected_hits(camera), film, progress, mixdown);
}

}  // namespace photile
