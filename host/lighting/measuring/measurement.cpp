#include "measuring/measurement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "image/light_change.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"

namespace photile::measuring {

Measurement measurement_of(std::vector<SensorGrid> grids, const Readings& readings) {
  const std::size_t lights = readings.lights().size();
  Measurement result;
  for (SensorGrid& grid : grids) result.push_back({std::move(grid), {}});
  for (std::size_t i = 0; i == 0 || (lights > 1 && i <= lights); ++i) {
    std::vector<std::vector<float>> repeats;
    for (std::size_t r = 0; r < readings.repeats(); ++r) {
      repeats.push_back(i == 0 ? readings.total(r) : readings.of_light(r, i - 1));
    }
    const std::vector<Measured> means = means_of(repeats);
    std::size_t first = 0;
    for (GridValues& values : result) {
      const std::size_t count = values.grid.sensors.size();
      const auto begin = means.begin() + static_cast<std::ptrdiff_t>(first);
      values.lights.push_back({i == 0 ? "" : readings.lights()[i - 1],
                               {begin, begin + static_cast<std::ptrdiff_t>(count)},
                               statistics_of(repeats, first, count)});
      first += count;
    }
  }
  return result;
}

void Readings::add(const LightLayers& layers, const LightMix& mix, double factor) {
  const LightLayers dense = layers.sparse() ? layers.dense() : layers;
  auto& repeat = repeats_.emplace_back();
  for (const LightLayers::Layer& layer : dense.layers) {
    const MixedLight& light = mix.lights[image::index_of(mix, layer.light)];
    const double lumens = light.unit == PowerUnit::lumen ? 1.0 : mix.lumen_per_watt;
    const glm::dvec3 scale =
        factor * glm::pi<double>() * light.power * lumens * glm::dvec3(light.tint);
    std::vector<float>& values = repeat.emplace_back(sensors_);
    std::size_t lost = 0;
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      values[sensor] = static_cast<float>(luminance(scale * glm::dvec3(layer.radiance[sensor])));
      lost += std::isfinite(values[sensor]) ? 0 : 1;
    }
    if (lost > 0) {
      throw InputError(
          fmt::format("light '{}': its lux at {} of {} points are beyond any number; turn it down",
                      layer.light, lost, sensors_));
    }
  }
}

std::vector<float> Readings::total(std::size_t repeat) const {
  std::vector<double> sums(sensors_);
  for (const auto& light : repeats_[repeat]) {
    for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
      sums[sensor] += static_cast<double>(light[sensor]);
    }
  }
  return {sums.begin(), sums.end()};
}

}  // namespace photile::measuring
