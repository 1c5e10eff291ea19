#include <memory>
#include <optional>

#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "render/hit_source.hpp"
#include "render/picture.hpp"
#include "render/render_session.hpp"

namespace photile {

RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress) {
  require_device(devices);
  const auto prepared = std::make_shared<const PreparedScene>(scene);
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
                             const RenderParameters& parameters, PreparedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress)
    : impl_(std::make_unique<Impl>(std::make_shared<const PreparedScene>(scene), devices,
                                   parameters, prepared, keep, progress)) {}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const Film& film, Progress& progress,
                                   const LightPooling* pooling) {
  return impl_->render(CameraHits(camera), film, progress, pooling);
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
                                               Progress& progress, const LightPooling* pooling) {
  return impl_->render(ReflectedHits(camera), film, progress, pooling);
}

}  // namespace photile
