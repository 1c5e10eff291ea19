#include "command/daylight_results.hpp"

#include <tbb/parallel_for.h>

#include <span>
#include <utility>

#include "daylight/daylight_metrics.hpp"

namespace photile::app {

using namespace daylight;
using report::GridDaylight;

namespace {

/// What the lamps over a grid use in a year.
std::vector<LampEnergy> energies_of(const DaylightOptions& options,
                                    const std::vector<LightIlluminance>& lamps, const LightMix& mix,
                                    const std::vector<bool>& occupied, const GridDaylight& grid,
                                    std::size_t first) {
  if (lamps.empty()) return {};
  const std::size_t count = grid.grid.sensors.size(), hours = occupied.size();
  std::vector<double> mean(hours, 0.0), of_lamp, watts;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count * hours; ++i)
    mean[i % hours] += double{grid.lux[i]} / static_cast<double>(count);
  for (const LightIlluminance& lamp : lamps) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += lamp.sensors[first + i].value;
    names.push_back(lamp.light);
    of_lamp.push_back(sum / static_cast<double>(count));
    for (const MixedLight& light : mix.lights) {
      if (light.name != lamp.light) continue;
      const double lumens = light.power * (light.unit == PowerUnit::lumen ? 1 : mix.lumen_per_watt);
      watts.push_back(lumens / options.lamp_efficacy);
    }
  }
  return lamp_energy(mean, occupied, names, of_lamp, watts, options.lamps_to);
}

/// Light of all points.
struct LightOfPoints {
  const std::vector<float>& lux;
  const std::vector<float>& sun;
  const DaylightMatrix& matrix;
};

std::vector<GridDaylight> results_of(const DaylightOptions& options, const Year& year,
                                     const std::vector<measuring::SensorGrid>& grids,
                                     const LightOfPoints& light,
                                     const std::vector<LightIlluminance>& lamps,
                                     const LightMix& mix) {
  const std::vector<bool>& occupied = options.asked.occupied;
  const std::vector<bool> by_day = daylight_hours(year.hours);
  const std::size_t hours = year.hours.size();
  std::vector<GridDaylight> results;
  std::size_t first = 0;
  for (const measuring::SensorGrid& grid : grids) {
    GridDaylight result;
    const std::size_t count = grid.sensors.size();
    const auto part = [&](const std::vector<float>& all, std::size_t each) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first * each);
      return all.empty()
                 ? std::vector<float>{}
                 : std::vector<float>(begin, begin + static_cast<std::ptrdiff_t>(count * each));
    };
    result.grid = grid;
    result.lux = part(light.lux, hours);
    result.sun = part(light.sun, hours);
    result.relative_error = part(light.matrix.relative_error, 1);
    result.points.resize(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t sensor) {
      const auto row = [&](const std::vector<float>& all) {
        return all.empty() ? std::span<const float>()
                           : std::span(all).subspan(sensor * hours, hours);
      };
      result.points[sensor] = point_daylight(row(result.lux), row(result.sun), occupied, by_day,
                                             options.asked.target_lux);
    });
    result.room = room_daylight(result.points);
    result.lamps = energies_of(options, lamps, mix, occupied, result, first);
    first += count;
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace

report::DaylightResults daylight_results(const DaylightOptions& options, const Year& year,
                                         const std::vector<measuring::SensorGrid>& grids,
                                         const std::vector<SkyState>& states,
                                         const std::vector<LightIlluminance>& lamps,
                                         const LightMix& mix) {
  report::DaylightResults results;
  const SkyState& open = states.front();
  if (states.size() == 1) {
    results.grids = results_of(options, year, grids, {open.lux, open.sun, open.matrix}, lamps, mix);
    return results;
  }
  const ScheduledSky scheduled = scheduled_sky(year, states);
  results.state_of_hour = scheduled.state_of_hour;
  results.grids =
      results_of(options, year, grids, {scheduled.lux, open.sun, open.matrix}, lamps, mix);
  for (const SkyState& state : states) {
    results.states.push_back(
        {state.name,
         results_of(options, year, grids, {state.lux, state.sun, state.matrix}, lamps, mix)});
  }
  return results;
}

}  // namespace photile::app
