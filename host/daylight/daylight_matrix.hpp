// What each patch of the sky, and each lamp, gives each sensor: found once for a whole year.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "daylight/sky_patches.hpp"
#include "photile/illuminance.hpp"
#include "photile/ray_scene.hpp"

namespace photile::daylight {

struct DaylightMatrix {
  std::size_t sensors = 0;
  std::size_t patches = 0;  ///< those of the sky, then the ground below the horizon
  /// Lux at a sensor for each cd/m2 of a patch, by sensor, then patch.
  std::vector<float> from_sky;
  /// The part of it that comes straight, through panes at most.
  std::vector<float> straight;
  std::vector<std::string> lamps;  ///< groups of the scene's own lights
  std::vector<float> from_lamps;   ///< lux at their powers, by lamp, then sensor
  /// Standard error of the illuminance under the mean sky, over it, by sensor.
  std::vector<float> relative_error;

  double coefficient(std::size_t sensor, std::size_t patch) const {
    return from_sky[sensor * patches + patch];
  }
};

struct MatrixParameters {
  MeasuringParameters measuring;
  /// cd/m2 of each patch and of the ground, as a mean over the year: what is worth photons.
  std::vector<double> mean_luminance;
  bool straight = true;  ///< whether to find DaylightMatrix::straight
};

/// `gather`, repeated, of a scene whose sky is add_sky_lights.
///   sensors   in the scene file's world
///   mix       powers of the lamps
///   first     the light of the first patch
/// Errors: those of `gather`.
DaylightMatrix daylight_matrix(Scene scene, std::span<const Sensor> sensors, const LightMix& mix,
                               const std::vector<SkyPatch>& patches, std::span<Device> devices,
                               const MatrixParameters& parameters,
                               Progress& progress = Progress::none());

/// Share of the light from a direction that reaches a sensor straight, times the cosine, by sensor.
///   direction   unit, in the scene
///   sensors     in the scene file's world
class StraightLight {
 public:
  StraightLight(const Scene& scene, std::span<const Sensor> sensors);
  double from(const glm::dvec3& direction, std::size_t sensor) const;

 private:
  RayScene rays_;
  std::vector<Sensor> sensors_;  ///< in the scene's own coordinates, off their surfaces
  double beyond_;                ///< metres: behind all of the scene
};

}  // namespace photile::daylight
