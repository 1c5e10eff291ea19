#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <utility>

#include "measuring/measurement.hpp"
#include "photile/light_layers.hpp"
#include "report/daylight_tables.hpp"
#include "report/record.hpp"

namespace photile::report {

using namespace daylight;

namespace {

/// What the lamps over a grid use in a year.
std::vector<LampEnergy> energies_of(const YearLamps& lamps, const std::vector<bool>& occupied,
                                    const GridDaylight& grid, std::size_t first) {
  if (lamps.lux.empty()) return {};
  const std::size_t count = grid.grid.sensors.size(), hours = occupied.size();
  std::vector<double> mean(hours, 0.0), of_lamp;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count * hours; ++i)
    mean[i % hours] += double{grid.lux[i]} / static_cast<double>(count);
  for (const LightIlluminance& lamp : lamps.lux) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += lamp.sensors[first + i].value;
    names.push_back(lamp.light);
    of_lamp.push_back(sum / static_cast<double>(count));
  }
  return lamp_energy(mean, occupied, names, of_lamp, lamps.watts, lamps.target_lux);
}

/// Light of all points.
struct LightOfPoints {
  const std::vector<float>& lux;
  const std::vector<float>& sun;
  const DaylightMatrix& matrix;
};

/// The light of a grid's points, the first of which is that of the year's sensors.
std::vector<PointDaylight> points_of(const DaylightAsked& asked, const Year& year,
                                     const std::vector<float>& lux, const std::vector<float>& sun,
                                     std::size_t first, std::size_t count) {
  const std::vector<bool> by_day = daylight_hours(year.hours);
  const std::size_t hours = year.hours.size();
  std::vector<PointDaylight> points(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t sensor) {
    const auto row = [&](const std::vector<float>& all) {
      return all.empty() ? std::span<const float>()
                         : std::span(all).subspan((first + sensor) * hours, hours);
    };
    points[sensor] = point_daylight(row(lux), row(sun), asked.occupied, by_day, asked.target_lux);
  });
  return points;
}

std::vector<GridDaylight> results_of(const DaylightAsked& asked, const Year& year,
                                     const std::vector<measuring::SensorGrid>& grids,
                                     const LightOfPoints& light, const YearLamps& lamps) {
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
    result.points = points_of(asked, year, light.lux, light.sun, first, count);
    result.room = room_daylight(result.points);
    result.lamps = energies_of(lamps, asked.occupied, result, first);
    first += count;
    results.push_back(std::move(result));
  }
  return results;
}

/// Light by the hour of the states in turn, or of the only one.
std::vector<float> lux_of_year(const Year& year, std::vector<SkyState>& states) {
  light_hours(year, states);
  return states.size() == 1 ? std::move(states.front().lux) : scheduled_sky(year, states).lux;
}

void add_errors(const DaylightAsked& asked, const Year& year, const SkyRounds& rounds,
                std::vector<GridDaylight>& grids) {
  const std::vector<double> shares = rounds.part_fractions();
  if (shares.size() < 2) return;
  std::vector<std::vector<std::vector<PointDaylight>>> without(grids.size());
  for (std::size_t part = 0; part < shares.size(); ++part) {
    std::vector<SkyState> states = rounds.mean(part);
    const std::vector<float> sun = states.front().sun, lux = lux_of_year(year, states);
    std::size_t first = 0;
    for (std::size_t g = 0; g < grids.size(); ++g) {
      const std::size_t count = grids[g].points.size();
      without[g].push_back(points_of(asked, year, lux, sun, first, count));
      first += count;
    }
  }
  for (std::size_t g = 0; g < grids.size(); ++g) {
    grids[g].errors = daylight_errors(grids[g].points, without[g], shares);
  }
}

}  // namespace

YearLamps year_lamps(const Scene& scene, std::span<const Sensor> sensors, const LightMix& mix,
                     double target_lux, double efficacy, std::span<Device> devices,
                     const MeasuringParameters& parameters, Progress& progress) {
  YearLamps lamps{{}, {}, target_lux};
  const LightGroups groups = light_groups_of(scene);
  const std::vector<double> watts = watts_of(scene, mix, efficacy);
  std::vector<MixedLight> lights;
  std::vector<bool> reaches;
  for (LightIlluminance& lamp :
       measure_illuminance(scene, sensors, mix, devices, parameters, progress)) {
    const auto group = std::ranges::find(groups.groups, lamp.light, &LightGroup::name);
    if (group == groups.groups.end() || scene.lights[group->lights.front()].is_distant()) continue;
    const auto mixed = std::ranges::find(mix.lights, lamp.light, &MixedLight::name);
    lights.push_back(*mixed);
    lamps.watts.push_back(watts[static_cast<std::size_t>(mixed - mix.lights.begin())]);
    reaches.push_back(std::ranges::any_of(
        lamp.sensors, [](const Measured& measured) { return measured.value > 0; }));
    lamps.lux.push_back(std::move(lamp));
  }
  for (const auto& line : measuring::lights_that_reach_nothing(lights, reaches, "point"))
    progress.warn(line);
  return lamps;
}

DaylightResults daylight_results(const DaylightAsked& asked, const Year& year,
                                 const std::vector<measuring::SensorGrid>& grids,
                                 const SkyRounds& rounds, const YearLamps& lamps) {
  DaylightResults results;
  results.rounds = rounds.count();
  results.outdoor_lux = median_outdoors(year.hours);
  std::vector<SkyState> states = rounds.mean();
  light_hours(year, states);
  const SkyState& open = states.front();
  if (states.size() == 1) {
    results.grids = results_of(asked, year, grids, {open.lux, open.sun, open.matrix}, lamps);
  } else {
    const ScheduledSky scheduled = scheduled_sky(year, states);
    results.state_of_hour = scheduled.state_of_hour;
    results.grids = results_of(asked, year, grids, {scheduled.lux, open.sun, open.matrix}, lamps);
    for (const SkyState& state : states) {
      results.states.push_back(
          {state.name,
           results_of(asked, year, grids, {state.lux, state.sun, state.matrix}, lamps)});
    }
  }
  add_errors(asked, year, rounds, results.grids);
  return results;
}

}  // namespace photile::report
