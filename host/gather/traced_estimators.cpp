#include "gather/traced_estimators.hpp"

#include <memory>

#include "photile/neighbour_groups.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/surface_index.hpp"
#include "render/neighbour_choice.hpp"
#include "render/render_plan.hpp"

namespace photile {
namespace {

/// All photons at once, and those of direct light among them: rays see it where they end.
RenderParameters in_one_pass(RenderParameters asked) {
  asked.passes = 1;
  asked.direct_rays = 0;
  return asked;
}

}  // namespace

TracedEstimators::TracedEstimators(const RayScene& rays, std::span<Device> devices,
                                   const RenderParameters& parameters, Progress& progress)
    : layer_powers_(photile::layer_powers(rays.scene())) {
  const Scene& scene = rays.scene();
  const RenderPlan plan(in_one_pass(parameters), rays, progress);
  PhotonTracerParameters tracing = plan.tracing(0, {});
  tracing.keep_caustics = true;
  PhotonTracerResult traced = trace_photons(rays, tracing, progress);
  const double radius = plan.radius(traced.photons, progress);
  const NeighbourGroups groups =
      find_map_groups(scene, traced.photons, plan.map_mode(), plan.groups(radius), progress);
  const auto surface = plan.clips_areas()
                           ? std::make_shared<const SurfaceIndex>(index_surface(
                                 scene, traced.photons, radius, plan.used().angle_degrees))
                           : nullptr;
  const auto estimators_of = [&](Photons photons, std::shared_ptr<const SeenPhotons> seen) {
    return MapEstimators(devices, scene,
                         {build_maps_on_each(devices, scene, std::move(photons), groups,
                                             plan.maps(0, radius), progress),
                          plan.estimates(0, surface), std::move(seen)},
                         layer_powers_);
  };
  ends_ = plan.ends(0, radius, scene, traced.photons, layer_powers_);
  photons_.emplace(estimators_of(std::move(traced.photons), nullptr));
  if (traced.caustics.size() > 0) {
    auto seen = std::make_shared<const SeenPhotons>(rays, traced.caustics);
    caustics_.emplace(estimators_of(std::move(traced.caustics), std::move(seen)));
  }
}

}  // namespace photile
