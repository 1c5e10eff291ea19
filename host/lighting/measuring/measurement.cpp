#include "measuring/measurement.hpp"

#include <cstddef>
#include <utility>

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

}  // namespace photile::measuring
