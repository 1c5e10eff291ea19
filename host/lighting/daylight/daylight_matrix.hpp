// The light of each patch of the sky, and of each lamp, at each sensor: computed once for a whole
// year.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "photile/ray_scene.hpp"
#include "photile/sensors.hpp"
#include "weather/sky_patches.hpp"

namespace photile::daylight {

struct DaylightMatrix {
  std::size_t sensors = 0;
  std::size_t patches = 0;  ///< those of the sky, then the ground below the horizon
  /// Lux at a sensor for each cd/m2 of a patch, by sensor, then patch.
  std::vector<float> from_sky;
  /// The part of it that comes straight, through panes at most.
  std::vector<float> straight;
  /// Standard error of the illuminance under the mean sky, over it, by sensor.
  std::vector<float> relative_error;

  double coefficient(std::size_t sensor, std::size_t patch) const {
    return from_sky[sensor * patches + patch];
  }

  /// The mean of matrices of the same sensors, each by independent rays. `shares` add up to 1.
  static DaylightMatrix mean(std::span<const DaylightMatrix* const> of,
                             std::span<const double> shares);
};

struct MatrixParameters {
  /// Its rays and repeats, whose seeds follow from that of its photons. There are no photons.
  MeasuringParameters measuring;
  double north = 0;                    ///< radians clockwise from -z
  std::vector<double> mean_luminance;  ///< cd/m2 of each patch and of the ground, over the year
};

/// Light of the sky alone: none from the scene's lights. By rays and radiosity, see
/// light_transport.hpp.
///   sensors   in the scene file's world
/// Errors: Interrupted, when `progress` says so.
DaylightMatrix daylight_matrix(const Scene& scene, std::span<const Sensor> sensors,
                               const std::vector<weather::SkyPatch>& patches,
                               const MatrixParameters& parameters,
                               Progress& progress = Progress::none());

/// Share of the light from a direction that reaches a sensor straight, times the cosine, by sensor.
///   direction   unit, in the scene
///   sensors     in the scene file's world
class DirectLight {
 public:
  DirectLight(const Scene& scene, std::span<const Sensor> sensors);
  double from(const glm::dvec3& direction, std::size_t sensor) const;
  std::size_t sensors() const { return sensors_.size(); }

 private:
  RayScene rays_;
  std::vector<Sensor> sensors_;  ///< in the scene's own coordinates, off their surfaces
  double beyond_;                ///< metres: behind all of the scene
};

}  // namespace photile::daylight
