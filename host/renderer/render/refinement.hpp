// Pictures made again, each with more work than the one before, until one states a small enough
// error or the time is over.
#pragma once

#include <functional>

#include "photile/progress.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// What ends the making of pictures whose nodes gather; at least one of them is given.
struct RefinementGoal {
  double error = 0;    ///< relative standard error that a picture states, at most; 0 = none
  double seconds = 0;  ///< that all pictures may take, wall clock; 0 = none

  bool is_given() const { return error > 0 || seconds > 0; }
};

/// What refine asks for and tells.
struct RefinementSteps {
  /// Makes a picture. Errors: Interrupted, when `progress` says so.
  std::function<RenderResult(const RenderParameters&, Progress& progress)> make;
  /// A picture of these parameters is there, no worse than those before.
  std::function<void(const RenderParameters&, const RenderResult&)> finished;
  /// Since the time began to count, seconds.
  std::function<double()> elapsed;
};

/// Makes pictures until the goal is met, each with more work than the one before, and returns the
/// one that states the least error. For an error, the first has the settings given, and the next as
/// many times their work as leaves it, by a power of two. An error that no allowed work reaches, or
/// that no longer falls with it, ends this with a note. For a time, the first has a quarter of the
/// work, so that there is one soon, and is finished however long it takes; each later one is to take
/// most of what is left, as the last two tell, and is given up when the time is over. So with a time
/// the picture depends on how quick the machine is, but each is what render() makes of its own
/// settings.
/// Errors: those of `make`; Interrupted, when `progress` says so.
RenderResult refine(const RefinementGoal& goal, const RenderParameters& parameters,
                    const RefinementSteps& steps, Progress& progress);

/// The settings that the quality `final` has more of than `good` (photons, samples of a pixel, rays
/// of nodes) times `factor`, each within its range.
RenderParameters with_work(RenderParameters parameters, double factor);

/// Relative standard error that the statistics of a picture state; 0 where none is known.
double standard_error_of(const RenderResult& picture);

}  // namespace photile
