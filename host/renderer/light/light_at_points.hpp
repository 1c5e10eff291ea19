// The interface at the centre of rendering: the light that arrives at points of surfaces.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "photile/light_table.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::light {

/// Returns the irradiance and the reflected radiance of every light at points of opaque surfaces.
/// The photon estimate computes them from photons; rays that gather query another source where they
/// end; a cache interpolates samples from another source; and an exchange queries the process that
/// has the photons. PassLight chooses which of them a rendering uses.
class LightAtPoints {
 public:
  virtual ~LightAtPoints() = default;

  /// A row for each point, in the order of the points.
  /// Errors: DeviceError and what follows from it; Interrupted, when `progress` says so.
  virtual LightTable at(const PrimaryHits& points, const Progress& progress) = 0;
};

/// Radiance that a point sends against the ray that arrived, of one entry of its row.
inline glm::vec3 reflected_radiance(const PrimaryHits& points, std::size_t point,
                                    const LightTable& light, std::size_t entry) {
  return light.radiance.empty()
             ? points.diffuse_albedo[point] * glm::one_over_pi<float>() * light.irradiance[entry]
             : light.radiance[entry];
}

/// The powers of a scene's layers; all 1 where every light is off.
std::vector<double> layer_powers(const Scene& scene);

}  // namespace photile::light
