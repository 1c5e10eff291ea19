// Photons traced for gathering, and their maps.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "render/map_estimators.hpp"

namespace photile {

/// What IrradianceGather looks up: photons of all light, and caustics on their own.
class TracedEstimators {
 public:
  /// References are kept. Errors: those of the stages.
  ///   parameters   photons, maps, radius and estimate; what pictures are made of does not count
  TracedEstimators(const RayScene& rays, std::span<Device> devices,
                   const RenderParameters& parameters, Progress& progress = Progress::none());
  TracedEstimators(const TracedEstimators&) = delete;
  TracedEstimators& operator=(const TracedEstimators&) = delete;

  MapEstimators& photons() { return *photons_; }
  MapEstimators* caustics() { return caustics_ ? &*caustics_ : nullptr; }  ///< null without any
  /// Of light maps where rays end.
  const LightMapParameters& ends() const { return ends_; }
  std::span<const double> layer_powers() const { return layer_powers_; }

 private:
  std::vector<double> layer_powers_;
  LightMapParameters ends_;
  std::optional<MapEstimators> photons_, caustics_;
};

}  // namespace photile
