// What a measurement has read: sensors, lights, and repeats with random numbers of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

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

}  // namespace photile::measuring
