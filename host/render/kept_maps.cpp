#include "render/kept_maps.hpp"

#include <fmt/format.h>

#include "photile/errors.hpp"
#include "render/setting.hpp"

namespace photile {

KeptMaps::KeptMaps(const Scene& scene, std::span<Device> devices,
                   const RenderParameters& parameters, PreparedPhotons* prepared,
                   const KeepPhotons& keep, Progress& progress)
    : scene_(scene), rendering_(scene_, devices, parameters, progress) {
  const RenderPlan& plan = rendering_.plan();
  if (prepared && !prepared->caustics && plan.keeps_caustics()) {
    throw SettingError(
        setting_named(plan.gathers() ? "final_gather_rays" : "light_map_rays"),
        "rays that gather take caustics from photons of their own, which these saved maps lack; "
        "save them again with rays that gather");
  }
  if (const int passes = plan.passes(); passes > 1) {
    throw SettingError(
        setting_named("passes"),
        fmt::format("{} photon passes: walks, views, saved maps and glare need all photons in "
                    "memory at once; take fewer photons, or one pass where more memory may be had",
                    passes));
  }
  rendering_.prepare(0, prepared, keep ? &keep : nullptr);
}

RenderResult KeptMaps::render(const HitSource& hits, const Film& film, Progress& progress) {
  rendering_.report_to(progress);
  rendering_.start(film);
  rendering_.add_pass(hits);
  return rendering_.finish();
}

struct SceneRenderer::Impl : KeptMaps {
  using KeptMaps::KeptMaps;
};

SceneRenderer::SceneRenderer(const Scene& scene, std::span<Device> devices,
                             const RenderParameters& parameters, PreparedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress)
    : impl_(std::make_unique<Impl>(scene, devices, parameters, prepared, keep, progress)) {}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const Film& film, Progress& progress) {
  return impl_->render(CameraHits(camera), film, progress);
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
                                               Progress& progress) {
  return impl_->render(ReflectedHits(camera), film, progress);
}

}  // namespace photile
