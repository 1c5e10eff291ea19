// Pictures whose light maps grow, until one states a small enough error or the time is over.
#pragma once

#include <functional>

#include "photile/progress.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// The goals that end the growing of light maps whose nodes gather; at least one of them is given.
struct RefinementGoal {
  double error = 0;    ///< relative standard error that a picture states, at most; 0 = none
  double seconds = 0;  ///< that all pictures may take, wall clock; 0 = none

  bool is_given() const { return error > 0 || seconds > 0; }
};

/// The callbacks of refine.
struct RefinementSteps {
  /// Adds this many parts of work to those before, and makes the picture of all. Errors:
  /// Interrupted, when `progress` says so.
  std::function<RenderResult(int parts, Progress& progress)> make;
  /// The picture of this many parts is finished.
  std::function<void(int parts, const RenderResult&)> finished;
  /// Since the time began to count, seconds.
  std::function<double()> elapsed;
};

/// One part of the work on the way to the goal, where these settings are asked for: for an error
/// the settings themselves, for a time a quarter of their rays and samples, so that there is a
/// picture soon.
RenderParameters first_part(const RefinementGoal& goal, const RenderParameters& asked);

/// Adds parts until the goal is met, and returns the last picture. Each round makes one, and leads
/// to as many parts as `parts_after` says. An error that no allowed work reaches, or that no longer
/// falls with it, ends this with a note. For a time, the first round is finished however long it
/// takes, a round that is not likely to fit in what is left is not begun, and one that is not ready
/// when the time is over is given up. So with a time the picture depends on how quick the machine
/// is, but each is what render() makes of the settings of its parts (`of_parts`).
/// Errors: those of `make`; Interrupted, when `progress` says so.
RenderResult refine(const RefinementGoal& goal, const RenderParameters& part,
                    const RefinementSteps& steps, Progress& progress);

}  // namespace photile
