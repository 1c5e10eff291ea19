// A finished measurement: the values of the sensors of each grid, what standards ask of them, and
// their uncertainty by the noise of the measurement.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "measuring/sensor_grid.hpp"
#include "photile/device.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/sensors.hpp"

namespace photile::measuring {

/// Mean and standard error at each sensor.
///   repeats   per repeat the values of all sensors; at least 2
std::vector<Measured> means_of(std::span<const std::vector<float>> repeats);

/// Statistics of the sensors first .. first + count - 1. Standard errors are those of the jackknife
/// over repeats (Tukey, "Bias and confidence in not-quite large samples", 1958), which knows that
/// sensors share photons. It holds the darkest and the brightest sensor of all repeats: a jackknife
/// that chose them anew would converge to nothing where several are nearly as dark. The square of
/// the error of a minimum is then the variance of the reading of the sensor that looks darkest. In
/// the mean that is the variance of the minimum where one sensor is darkest in all measurements,
/// and an upper bound of it where noise chooses (Poincare's inequality for normal readings, whether
/// they are correlated or not). It says nothing of the bias, which the next two figures bound.
struct GridStatistics {
  Measured mean;        ///< Em
  Measured minimum;     ///< Emin: the least of the sensors' means
  Measured maximum;     ///< Emax
  Measured uniformity;  ///< Uo = Emin / Em
  Measured diversity;   ///< Ud = Emin / Emax
  /// The minimum of noisy values is low and their maximum high. These are what the sensors that
  /// look darkest (brightest) to all repeats but one read in that one: high (low) if anything. The
  /// truth lies between minimum and minimum_at_most, maximum_at_least and maximum, up to their
  /// standard errors.
  double minimum_at_most = 0;
  double maximum_at_least = 0;
};
GridStatistics statistics_of(std::span<const std::vector<float>> repeats, std::size_t first,
                             std::size_t count);

/// Illuminance in lux.
class Readings {
 public:
  Readings(std::vector<std::string> lights, std::size_t sensors)
      : lights_(std::move(lights)), sensors_(sensors) {}

  /// Adds a repeat: the layers of `gather`, each at its power in the mix.
  ///   factor   of all values: the maintenance factor
  /// Errors: InputError naming a light whose lux no number holds.
  void add(const LightLayers& layers, const LightMix& mix, double factor);

  std::size_t sensors() const { return sensors_; }
  std::size_t repeats() const { return repeats_.size(); }
  const std::vector<std::string>& lights() const { return lights_; }

  /// The lux of all lights together, per sensor.
  std::vector<float> total(std::size_t repeat) const;
  /// The lux in each repeat of all lights together (0), or of light i - 1.
  std::vector<std::vector<float>> repeats_of(std::size_t i) const;
  /// The light's name; "" of all together.
  std::string name_of(std::size_t i) const { return i == 0 ? "" : lights_[i - 1]; }

 private:
  std::vector<std::string> lights_;
  std::size_t sensors_;
  std::vector<std::vector<std::vector<float>>> repeats_;  ///< [repeat][light][sensor]
};

/// Values of one light, or of all together, at the sensors of a grid.
struct LightValues {
  std::string light;  ///< "" for all together
  std::vector<Measured> sensors;
  GridStatistics statistics;
};

struct GridValues {
  SensorGrid grid;
  std::vector<LightValues> lights;  ///< all together first; with one light, nothing else

  const LightValues& total() const { return lights.front(); }
};

using Measurement = std::vector<GridValues>;  ///< lux

/// The values of each grid. `readings` are those of all grids' sensors, one grid after the other.
Measurement measurement_of(std::vector<SensorGrid> grids, const Readings& readings);

/// Marks the points without any light, where others have some.
void mark_dark_points(Measurement& measurement);

/// Warnings of what is allowed but seldom intended, a line each: points without any light, and
/// lights that reach no point.
///   lights   their powers; those of 0 are off
std::vector<std::string> doubts_of(const Measurement& measurement,
                                   std::span<const MixedLight> lights);

/// Why the light of a sky does not reach a room, and the remedy.
inline constexpr const char* closed_to_the_sky =
    "the room has no opening and no glass; hide what closes its windows, or make it glass "
    "(KHR_materials_transmission in glTF, d below 1 or illum 4 in MTL)";

/// A line for each light that is on and reaches nothing; one for all of the sky. The ground is not
/// named: a floor in the scene may hide it.
///   reaches   whether each of the lights does
///   what      what they do not reach, such as "point"
std::vector<std::string> lights_that_reach_nothing(std::span<const MixedLight> lights,
                                                   const std::vector<bool>& reaches,
                                                   const std::string& what);

/// The readings of all grids' sensors, one grid after the other. Errors: those of `gather`.
Readings measure_grids(const Scene& scene, std::span<const SensorGrid> grids, const LightMix& mix,
                       std::span<Device> devices, const MeasuringParameters& parameters,
                       Progress& progress);

/// measure_grids, with luminaires that have a maintenance factor of their own (LuminaireData) at
/// that in place of the parameters'.
Readings measure_maintained(const Scene& scene, std::span<const SensorGrid> grids,
                            const LightMix& mix, std::span<Device> devices,
                            const MeasuringParameters& parameters, Progress& progress);

/// Scene::portals of the rooms of the grids, where light comes from beyond the scene.
///   asked   as SceneLoadOptions::portals
/// Errors: those of portals_asked_for.
std::vector<Portal> portals_of_grids(const Scene& scene, std::span<const SensorGrid> grids,
                                     std::span<const std::string> asked);

/// Makes all surfaces black, but for glass: what remains is direct light.
void remove_reflections(Scene& scene);

/// Warnings before anything is measured: sensors with a surface less than a centimetre in front of
/// them, which are in furniture or just below a top, and light that cannot reach any.
std::vector<std::string> doubts_of(const Scene& scene, std::span<const SensorGrid> grids);

}  // namespace photile::measuring
