// More work for a better result: it is done in parts, round by round, until a goal is met. This is
// how pictures and pages with light maps whose nodes gather are made, and years of daylight.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "photile/progress.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// What ends the rounds.
struct RefinementGoal {
  double error = 0;    ///< relative standard error of the result, at most; 0 = none
  double seconds = 0;  ///< that all rounds may take, wall clock; 0 = none
  int parts = 1;       ///< the least number of parts, however long they take

  bool is_given() const { return error > 0 || seconds > 0; }
};

/// The factor on the photons of a part when there are this many parts of rays and samples: photons
/// err less than rays, and nodes need to be closer only when the error of rays is small.
constexpr int photons_of_parts(int parts) {
  int photons = 1;
  while (parts / 16 >= photons) photons *= 4;
  return photons;
}

/// The numbers of parts after which rounds end where each round makes its result anew: 1, 2, 3, 4,
/// 6, 8, 12, 16 and so on.
constexpr int parts_after(int parts) {
  const int power = static_cast<int>(std::bit_floor(static_cast<unsigned>(parts)));
  return parts == power ? parts + std::max(1, parts / 2) : 2 * power;
}

/// The work of all rounds that add up to `parts` parts of a picture, in proportion to their time.
double work_of_pictures(int parts);

/// The callbacks of refine, and the growth of the work.
struct RefinementSteps {
  /// Adds this many parts to those before. Returns the standard error of the result of all. Errors:
  /// Interrupted, when `progress` says so.
  std::function<double(int parts, Progress& progress)> add;
  /// Called when the result of this many parts is ready.
  std::function<void(int parts, double error)> finished = [](int, double) {};
  /// Seconds since the start of the time limit.
  std::function<double()> elapsed = [] { return 0.0; };
  int most_parts = std::numeric_limits<int>::max();
  int (*next)(int parts) = parts_after;
  double (*work)(int parts) = work_of_pictures;
};

/// Adds parts until the goal is met, and returns the last error. An error that the allowed work
/// cannot reach, or that no longer falls with more work, ends this with a note. With a time limit,
/// a round that is not likely to fit in the remaining time is not begun, and one that is not ready
/// when the time is over is cancelled. The result then depends on the speed of the machine, but
/// each picture is what render() makes of the settings of its parts (`of_parts`). Errors: those of
/// `add`; Interrupted, when `progress` says so.
double refine(const RefinementGoal& goal, const RefinementSteps& steps, Progress& progress);

/// Whether these settings ask for parts (docs/method/rounds.md): nodes of light maps gather, and
/// there are several passes, each a part of the work.
bool in_parts(const RenderParameters& asked);
/// The settings of this many parts together, which are `in_parts` where there are several.
RenderParameters of_parts(const RenderParameters& part, int parts);
/// The settings of one of its parts, which has a ray, a photon and a sample at least. `all.passes`
/// is at least 1.
RenderParameters part_of(const RenderParameters& all);
/// One part of the work towards the goal, given the requested settings: for an error the settings
/// themselves, for a time a quarter of their rays and samples, so that there is a picture soon.
RenderParameters first_part(const RefinementGoal& goal, const RenderParameters& asked);
}  // namespace photile
