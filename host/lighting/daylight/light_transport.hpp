// How light of the sky's patches reaches sensors: straight, and over surface in cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "daylight/sky_rays.hpp"
#include "photile/progress.hpp"
#include "photile/sensors.hpp"

namespace photile::daylight {

/// A place, as a row of the system E = D L + F E of radiosity (Goral et al. 1984), whose
/// coefficients rays find.
struct TransportRow {
  struct OfPatch {
    std::uint32_t patch;
    glm::vec3 all{0.0f}, straight{0.0f};  ///< lux for each cd/m2
  };
  struct OfCell {
    std::uint32_t cell, batch;
    glm::vec3 weight;  ///< lux for each lux on the cell
  };
  std::vector<OfPatch> patches;     ///< ascending
  std::vector<OfCell> cells;        ///< by cell, then batch
  std::vector<glm::vec3> mean_sky;  ///< lux under the mean sky, by batch
};

struct LightTransport {
  std::vector<TransportRow> sensors, cells;
  std::size_t patches = 0;  ///< those of the sky, then the ground
  int batches = 0;
  bool coloured = false;  ///< whether channels differ
};

struct TransportParameters {
  int rays = 256;  ///< of a sensor and batch
  SkyRayParameters sky;
  SensorResponse response = SensorResponse::planar;
  std::vector<double> mean_luminance;  ///< cd/m2 of the patches and the ground
};

/// Rays from the sensors end in cells; rays from these ends, in turn, tell what lights them.
///   sensors   in the scene's coordinates
LightTransport light_transport(const RayScene& rays, std::span<const Sensor> sensors,
                               const weather::PatchFinder& patches,
                               const TransportParameters& parameters, Progress& progress);

/// Lux for each cd/m2, by sensor, then patch: solved for all patches at once.
std::vector<float> lux_of_patches(const LightTransport& transport);

/// Lux under the mean sky, by batch, then sensor: each from the rays of one batch alone.
std::vector<std::vector<double>> lux_of_batches(const LightTransport& transport);

}  // namespace photile::daylight
