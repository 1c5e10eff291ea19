#include "render/render_session.hpp"

#include <fmt/format.h>

#include <utility>

#include "photile/errors.hpp"
#include "render/picture.hpp"
#include "render/setting.hpp"

namespace photile {
namespace {

/// Errors: UsageError and SettingError where the passes cannot be kept, or not from these photons.
void check_kept(const RenderPlan& plan, const PreparedPhotons* prepared, bool keeps) {
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
                             const RenderParameters& parameters, PreparedPhotons* prepared,
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
    frames_.emplace(scene_->rays, light().cache()->maps(), light().nodes());
  }
}

RenderResult RenderSession::render(const HitSource& hits, const Film& film, Progress& progress,
                                   const LightPooling* pooling) {
  Picture picture(scene_->rays, plan_, devices_, film, plan_.passes(), pooling, costs_);
  for (const auto& pass : passes_) picture.add(hits, *pass, progress);
  return picture.finish(photons_.radius());
}

std::optional<LightMapContents> RenderSession::light_map_contents() const {
  if (!reads_light_maps()) return std::nullopt;
  const LightMaps& maps = passes_.front()->cache()->maps();
  if (maps.statistics().nodes == 0) return std::nullopt;
  LightMapContents contents = maps.contents();
  contents.settings = photons_.light_map_settings();
  return contents;
}

}  // namespace photile
