#include "daylight/sky_states.hpp"

#include <bit>
#include <utility>

namespace photile::daylight {
namespace {

std::string name_of(std::span<const BlindGroup> groups, BlindState state) {
  if (state == 0) return "open";
  if (std::cmp_equal(std::popcount(state), groups.size())) return "closed";
  std::string name;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    if ((state >> group & 1) != 0) name += (name.empty() ? "closed: " : ", ") + groups[group].glob;
  }
  return name;
}

}  // namespace

SkyState sky_state(const Year& year, const Scene& scene, std::string name, int closed,
                   Progress& progress) {
  SkyState state{std::move(name), closed, {}, {}, {}};
  state.matrix = daylight_matrix(scene, year.sensors, year.patches, year.parameters, progress);
  if (year.suns_by_rays) {
    state.sun = sun_profile(StraightLight(scene, year.sensors), year.hours, year.parameters.north,
                            year.parameters.measuring.maintenance);
  }
  state.lux = annual_profile(state.matrix, year.hours, year.patches, state.sun);
  return state;
}

std::vector<SkyState> sky_states(const Year& year, Scene& scene, std::span<const BlindGroup> groups,
                                 Progress& progress) {
  const std::vector<Material> open = scene.materials;
  const BlindState all = (BlindState{1} << groups.size()) - 1;
  std::vector<SkyState> states;
  for (BlindState state = 0; state <= all; ++state) {
    std::vector<Material> materials = materials_with(scene, groups, state);
    std::swap(scene.materials, materials);
    states.push_back(
        sky_state(year, scene, name_of(groups, state), std::popcount(state), progress));
    scene.materials = open;
  }
  return states;
}

ScheduledSky scheduled_sky(const Year& year, const std::vector<SkyState>& states) {
  const std::size_t hours = year.hours.size(), sensors = year.sensors.size();
  std::vector<std::vector<float>> sun;
  std::vector<int> closed;
  for (const SkyState& state : states) {
    sun.push_back(state.sun);
    closed.push_back(state.closed);
  }
  ScheduledSky scheduled{blind_schedule(sun, closed, sensors, hours), {}};
  scheduled.lux.resize(sensors * hours);
  for (std::size_t i = 0; i < scheduled.lux.size(); ++i)
    scheduled.lux[i] = states[scheduled.state_of_hour[i % hours]].lux[i];
  return scheduled;
}

}  // namespace photile::daylight
