#include <fmt/format.h>

#include "measuring/grid_statistics.hpp"
#include "measuring/measure_grids.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"

namespace photile {

std::vector<LightIlluminance> measure_illuminance(const Scene& scene,
                                                  std::span<const Sensor> sensors,
                                                  const LightMix& mix, std::span<Device> devices,
                                                  const MeasuringParameters& parameters,
                                                  Progress& progress) {
  if (parameters.repeats < 2 || parameters.repeats > limits::max_repeats) {
    throw UsageError(fmt::format("repeats: '{}' is not a whole number from 2 to {}",
                                 parameters.repeats, limits::max_repeats));
  }
  const std::vector<measuring::SensorGrid> grids{
      {"points", {sensors.begin(), sensors.end()}, std::nullopt}};
  const measuring::Readings readings =
      measuring::measure_grids(scene, grids, mix, devices, parameters, progress);
  std::vector<LightIlluminance> result;
  for (std::size_t i = 0; i <= readings.lights().size(); ++i) {
    std::vector<std::vector<float>> repeats;
    for (std::size_t r = 0; r < readings.repeats(); ++r) {
      repeats.push_back(i == 0 ? readings.total(r) : readings.of_light(r, i - 1));
    }
    result.push_back({i == 0 ? "" : readings.lights()[i - 1], measuring::means_of(repeats)});
  }
  return result;
}

}  // namespace photile
