// The one question that rendering asks: what light arrives at points of surfaces.
#pragma once

#include "photile/estimator.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"

namespace photile::estimate {

/// Tells the irradiance and the reflected radiance of every light at points of opaque surfaces.
/// The photon estimate answers by photons, rays that gather by asking another where they end, a
/// cache by samples that another valued, and an exchange by asking the process that has the
/// photons. RenderPlan::light says which of them a rendering is made of.
class LightAtPoints {
 public:
  virtual ~LightAtPoints() = default;

  /// Each light at power 1, a row for each point, in the order of the points.
  /// Errors: DeviceError and what follows from it; Interrupted, when `progress` says so.
  virtual Estimates at(const PrimaryHits& points, const Progress& progress) = 0;
};

}  // namespace photile::estimate
