// A finished measurement: grids with the values of their sensors and what follows from them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "measuring/grid_statistics.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/light_layers.hpp"
#include "photile/light_mix.hpp"

namespace photile::measuring {

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

  /// Of one light in one repeat, per sensor.
  const std::vector<float>& of_light(std::size_t repeat, std::size_t light) const {
    return repeats_[repeat][light];
  }
  /// Of all lights together.
  std::vector<float> total(std::size_t repeat) const;

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

}  // namespace photile::measuring
