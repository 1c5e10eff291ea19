#include "gather/traced_estimators.hpp"

#include <memory>

#include "photile/light_groups.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/surface_index.hpp"
#include "render/neighbour_choice.hpp"

namespace photile {

TracedEstimators::TracedEstimators(const RayScene& rays, std::span<Device> devices,
                                   const RenderParameters& parameters, Progress& progress)
    : layer_powers_(photile::layer_powers(rays.scene())) {
  const Scene& scene = rays.scene();
  PhotonTracerParameters tracing = parameters.photons;
  tracing.keep_caustics = true;
  const PhotonTracerResult traced = trace_photons(rays, tracing, progress);
  const double radius = parameters.radius > 0
                            ? parameters.radius
                            : automatic_radius(traced.photons, parameters.neighbours);
  const NeighbourGroups groups = find_map_groups(scene, traced.photons, parameters.maps,
                                                 {radius, parameters.angle_degrees}, progress);
  const auto surface =
      parameters.area_used() == AreaMode::clipped
          ? std::make_shared<const SurfaceIndex>(index_surface(
                scene, landed_on(scene, traced.photons), radius, parameters.angle_degrees))
          : nullptr;
  const auto estimators_of = [&](const Photons& photons) {
    return MapEstimators(
        devices, scene,
        build_maps_on_each(devices, scene, photons, groups,
                           {radius, parameters.photons_per_cell, parameters.structure}, progress),
        parameters.neighbours, parameters, surface, layer_powers_);
  };
  photons_.emplace(estimators_of(traced.photons));
  if (traced.caustics.size() > 0) caustics_.emplace(estimators_of(traced.caustics));
}

}  // namespace photile
