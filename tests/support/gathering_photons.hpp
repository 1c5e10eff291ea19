// Photons for rays that gather at any points, without a picture.
#pragma once

#include <span>
#include <vector>

#include "cache/irradiance_gather.hpp"
#include "light/light_at_points.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "render/photon_passes.hpp"

namespace photile::test {

/// What IrradianceGather asks: photons of all light, and caustics on their own.
class GatheringPhotons {
 public:
  /// References are kept. Errors: those of the stages.
  ///   parameters   photons, maps, radius and estimate; what pictures are made of does not count
  GatheringPhotons(const RayScene& rays, std::span<Device> devices,
                   const RenderParameters& parameters)
      : rays_(rays),
        plan_(gathering(parameters), rays, HitsAsk::pictures, Progress::none()),
        passes_(rays, devices, plan_, costs_),
        photons_(passes_.next(nullptr, nullptr, Progress::none())),
        layer_powers_(light::layer_powers(rays.scene())) {}
  GatheringPhotons(const GatheringPhotons&) = delete;
  GatheringPhotons& operator=(const GatheringPhotons&) = delete;

  cache::IrradianceGather gather(cache::IrradianceGatherParameters parameters) const {
    parameters.caustic_neighbours = plan_.used().neighbours;
    return cache::IrradianceGather(rays_, light(), photons_.ends, photons_.caustics.get(),
                                   parameters);
  }
  /// By photons of all light.
  light::LightAtPoints& light() const { return *photons_.all; }
  std::span<const double> layer_powers() const { return layer_powers_; }

 private:
  static RenderParameters gathering(RenderParameters parameters) {
    parameters.passes = 1;
    parameters.direct_rays = 0;
    parameters.light_maps = LightMapMode::on;
    parameters.light_map_rays = 1;
    return parameters;
  }

  const RayScene& rays_;
  const RenderPlan plan_;
  RenderCosts costs_;
  PhotonPasses passes_;
  PassPhotons photons_;
  std::vector<double> layer_powers_;
};

}  // namespace photile::test
