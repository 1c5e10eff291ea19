#include "render/kept_maps.hpp"

#include <fmt/format.h>

#include "photile/errors.hpp"
#include "render/setting.hpp"

namespace photile {

KeptMaps::KeptMaps(std::shared_ptr<const PreparedScene> scene, std::span<Device> devices,
                   const RenderParameters& parameters, PreparedPhotons* prepared,
                   const KeepPhotons& keep, Progress& progress)
    : scene_(std::move(scene)),
      devices_(devices),
      parameters_(parameters),
      rendering_(*scene_, devices, parameters, progress) {
  const RenderPlan& plan = rendering_.plan();
  if (plan.used().processes && (prepared || keep)) {
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
  rendering_.prepare(0, prepared, keep ? &keep : nullptr);
}

KeptMaps::Pass KeptMaps::prepare_pass(int pass, std::vector<Device> devices,
                                      Progress& progress) const {
  Pass made{std::move(devices), nullptr};
  const std::span<Device> used = made.devices.empty() ? devices_ : std::span(made.devices);
  made.rendering = std::make_unique<Rendering>(*scene_, used, parameters_, progress);
  made.rendering->follow(rendering_, pass);
  made.rendering->report_to(Progress::none());
  return made;
}

void KeptMaps::add(Pass pass) {
  further_.push_back(std::move(pass));
  rendering_.add(*further_.back().rendering);
}

void KeptMaps::add_passes(Progress& progress) {
  for (int pass = rendering_.passes_kept(); pass < rendering_.plan().passes(); ++pass) {
    add(prepare_pass(pass, {}, progress));
  }
}

RenderResult KeptMaps::render(const HitSource& hits, const Film& film, Progress& progress,
                              const LightPooling* pooling) {
  rendering_.report_to(progress);
  rendering_.start(film, rendering_.passes_kept(), pooling);
  for (int pass = 0; pass < rendering_.passes_kept(); ++pass) {
    rendering_.add_pass(hits, static_cast<std::size_t>(pass));
  }
  return rendering_.finish();
}

struct SceneRenderer::Impl : KeptMaps {
  using KeptMaps::KeptMaps;
};
struct SceneRenderer::Pass : KeptMaps::Pass {};

SceneRenderer::SceneRenderer(const Scene& scene, std::span<Device> devices,
                             const RenderParameters& parameters, PreparedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress, Passes passes)
    : impl_(std::make_unique<Impl>(std::make_shared<const PreparedScene>(scene), devices,
                                   parameters, prepared, keep, progress)) {
  if (passes == Passes::all) impl_->add_passes(progress);
}

SceneRenderer::~SceneRenderer() = default;

std::shared_ptr<SceneRenderer::Pass> SceneRenderer::prepare_pass(int pass,
                                                                 std::vector<Device> devices,
                                                                 Progress& progress) const {
  return std::make_shared<Pass>(Pass{impl_->prepare_pass(pass, std::move(devices), progress)});
}

void SceneRenderer::add(Pass& pass) { impl_->add(std::move(pass)); }

RenderResult SceneRenderer::render(const Camera& camera, const Film& film, Progress& progress,
                                   const LightPooling* pooling) {
  return impl_->render(CameraHits(camera), film, progress, pooling);
}

DrawnFrame SceneRenderer::draw(const Camera& camera, const Film& film,
                               std::span<const glm::vec3> powers, double fill_seconds,
                               std::span<glm::vec3> picture, Progress& progress) {
  return impl_->frames(progress).draw(camera, film, powers, fill_seconds, picture, progress);
}

void SceneRenderer::bound_light_maps(std::uint64_t bytes) {
  if (draws()) impl_->frames(Progress::none()).bound(bytes);
}

bool SceneRenderer::draws() const { return impl_->reads_light_maps(); }

std::optional<LightMapContents> SceneRenderer::light_maps() const {
  return impl_->light_map_contents();
}

RenderResult SceneRenderer::render_reflections(const Camera& camera, const Film& film,
                                               Progress& progress, const LightPooling* pooling) {
  return impl_->render(ReflectedHits(camera), film, progress, pooling);
}

}  // namespace photile
