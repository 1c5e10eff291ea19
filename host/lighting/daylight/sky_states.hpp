// A year in each state of the blinds.
#pragma once

#include <string>
#include <vector>

#include "daylight/annual_daylight.hpp"
#include "daylight/blinds.hpp"
#include "daylight/daylight_matrix.hpp"
#include "photile/progress.hpp"

namespace photile::daylight {

/// What is the same in all states.
struct Year {
  std::vector<SkyHour> hours;
  std::vector<weather::SkyPatch> patches;
  std::vector<Sensor> sensors;  ///< in the scene file's world
  bool suns_by_rays = true;     ///< and not by the nearest patches
  MatrixParameters parameters;
};

struct SkyState {
  std::string name;  ///< "open", "closed", or which groups are closed
  int closed = 0;    ///< groups
  DaylightMatrix matrix;
  std::vector<float> sun, lux;  ///< by sensor, then hour; `sun` empty where it is patches
};

/// A scene as it is.
SkyState sky_state(const Year& year, const Scene& scene, std::string name, int closed,
                   Progress& progress);

/// A scene without blinds first, with all of them last. Errors: those of materials_with.
std::vector<SkyState> sky_states(const Year& year, Scene& scene, std::span<const BlindGroup> groups,
                                 Progress& progress);

/// The states as blind_schedule has them follow each other.
struct ScheduledSky {
  std::vector<std::size_t> state_of_hour;
  std::vector<float> lux;  ///< by sensor, then hour
};
ScheduledSky scheduled_sky(const Year& year, const std::vector<SkyState>& states);

}  // namespace photile::daylight
