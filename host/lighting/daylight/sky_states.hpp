// A year in each state of the blinds, which close where the sun comes in (IES LM-83).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daylight/annual_daylight.hpp"
#include "daylight/daylight_matrix.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile::daylight {

/// Panes whose blinds close together: all of the materials that a glob names.
struct BlindGroup {
  std::string glob;
  double transmittance = 0;  ///< of a pane with its blind, straight through it

  /// Splits GLOB=TRANSMITTANCE at the last '='. Errors: UsageError.
  static BlindGroup parse(const std::string& text);
};

/// States of all groups, as bits: 1 = closed.
using BlindState = std::uint32_t;
inline constexpr std::size_t most_blind_groups = 4;

/// Materials with the blinds of a state. Errors: UsageError that names a group whose glob matches
/// no material, or one that is no thin pane, or lets less through without its blind.
std::vector<Material> materials_with(const Scene& scene, std::span<const BlindGroup> groups,
                                     BlindState state);

/// By the hour the state with the fewest closed groups in which the sun gives 1,000 lux or more to
/// no more than 2% of the points; all closed where there is none.
///   sun       lux straight from the sun, of each state, by sensor, then hour
///   closed    of each state: how many groups are closed
std::vector<std::size_t> blind_schedule(std::span<const std::vector<float>> sun,
                                        std::span<const int> closed, std::size_t sensors,
                                        std::size_t hours);

/// The data that is the same in all states.
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

/// A scene as it is, its `lux` left to light_hours.
SkyState sky_state(const Year& year, const Scene& scene, std::string name, int closed,
                   Progress& progress);

/// A scene without blinds first, with all of them last; `lux` as above. Errors: those of
/// materials_with.
std::vector<SkyState> sky_states(const Year& year, Scene& scene, std::span<const BlindGroup> groups,
                                 Progress& progress);

/// The light of the states by the hour.
void light_hours(const Year& year, std::vector<SkyState>& states);

/// The same states repeated with independent rays: their mean, and its error.
class SkyRounds {
 public:
  static constexpr std::size_t most_parts = 8;

  /// The sun of rounds after the first is left out: its rays are always the same.
  Year year_of_next(const Year& year) const;
  void add(std::vector<SkyState> round);
  std::size_t count() const { return count_; }

  /// The rounds are dealt to parts in turn; the fractions that these have of them.
  std::vector<double> part_fractions() const;
  /// The mean of all rounds, or of those outside a part; `lux` as above.
  std::vector<SkyState> mean(std::optional<std::size_t> without = std::nullopt) const;

 private:
  std::size_t count_ = 0;
  std::vector<std::vector<SkyState>> parts_;  ///< means
};

/// The states as blind_schedule has them follow each other.
struct ScheduledSky {
  std::vector<std::size_t> state_of_hour;
  std::vector<float> lux;  ///< by sensor, then hour
};
ScheduledSky scheduled_sky(const Year& year, const std::vector<SkyState>& states);

}  // namespace photile::daylight
