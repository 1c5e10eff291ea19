#include <memory>
#include <span>
#include <string>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "render/hit_source.hpp"
#include "render/rendering.hpp"

namespace photile {
namespace {

void check(std::span<const Device> devices, const RenderParameters& parameters) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
  if (parameters.least_neighbours < 0 || parameters.least_neighbours > parameters.neighbours) {
    throw UsageError("least neighbours: " + std::to_string(parameters.least_neighbours) +
                     " is not between 0 and the " + std::to_string(parameters.neighbours) +
                     " neighbours");
  }
  if (parameters.passes < 0 || parameters.passes > limits::max_passes) {
    throw UsageError("passes: " + std::to_string(parameters.passes) + " is not between 0 and " +
                     std::to_string(limits::max_passes));
  }
  if (parameters.final_gather_rays < 0 ||
      parameters.final_gather_rays > limits::max_final_gather_rays) {
    throw UsageError("final gathering: " + std::to_string(parameters.final_gather_rays) +
                     " rays are not between 0 and " +
                     std::to_string(limits::max_final_gather_rays));
  }
}

}  // namespace

RenderResult render_hits(const Scene& scene, const HitSource& hits, std::span<Device> devices,
                         const RenderParameters& parameters, Progress& progress) {
  check(devices, parameters);
  Rendering rendering(scene, devices, parameters, progress);
  rendering.start(parameters.film);
  for (int pass = 0; pass < rendering.passes(); ++pass) {
    rendering.prepare(pass, nullptr, nullptr);
    rendering.add_pass(hits);
  }
  return rendering.finish();
}

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, CameraHits(camera), devices, parameters, progress);
}

struct SceneRenderer::Impl : Rendering {
  using Rendering::Rendering;

  RenderResult render(const HitSource& hits, const PrimaryHitParameters& film, Progress& progress) {
    report_to(progress);
    start(film);
    add_pass(hits);
    return finish();
  }
};

SceneRenderer::SceneRenderer(const Scene& scene, std::span<Device> devices,
                             const RenderParameters& parameters, PreparedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress) {
  check(devices, parameters);
  if (parameters.final_gather_rays > 0 && (prepared || keep)) {
    throw UsageError(
        "final gathering takes caustics from photons of their own, which saved maps do not hold: "
        "trace the photons anew, or leave it out");
  }
  impl_ = std::make_unique<Impl>(scene, devices, parameters, progress);
  if (impl_->passes() > 1) {
    throw UsageError(
        std::to_string(impl_->passes()) +
        " photon passes: walks, views, saved maps and glare need all photons in memory "
        "at once; give fewer --photons, or --passes 1 where more memory may be taken");
  }
  impl_->prepare(0, prepared, keep ? &keep : nullptr);
}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const PrimaryHitParameters& film,
                                   Progress& progress) {
  return impl_->render(CameraHits(camera), film, progress);
}

RenderResult SceneRenderer::render(const HitSource& hits, const PrimaryHitParameters& film,
                                   Progress& progress) {
  return impl_->render(hits, film, progress);
}

RenderResult SceneRenderer::render_reflections(const Camera& camera,
                                               const PrimaryHitParameters& film,
                                               Progress& progress) {
  return impl_->render(ReflectedHits(camera), film, progress);
}

RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress) {
  return render(scene, camera, std::span(&device, 1), parameters, progress);
}

}  // namespace photile
