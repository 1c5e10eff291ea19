// Pictures made again, each with more photons and rays than the one before, until one is good
// enough or the time is over.
#pragma once

#include <functional>

#include "photile/progress.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// What ends the making of pictures whose nodes gather; at least one of them is given.
struct RefinementGoal {
  double error = 0;    ///< relative standard error of a picture, at most; 0 = none
  double seconds = 0;  ///< that all pictures may take, wall clock; 0 = none
};

/// What refine asks for and tells.
struct RefinementSteps {
  /// Makes a picture. Errors: Interrupted, when `progress` says so.
  std::function<RenderResult(const RenderParameters&, Progress& progress)> make;
  /// A picture is there, better than those before.
  std::function<void(const RenderResult&)> finished;
  /// Since the time began to count, seconds.
  std::function<double()> elapsed;
};

/// Makes pictures until the goal is met, and returns the last that was finished: each has photons
/// and rays of nodes in one proportion, as many more as the error asks for and the time allows.
/// With a time the first has a quarter of what is asked, so that there is one soon; it is finished
/// however long it takes, and one that the end of the time finds unfinished is given up. Then the
/// picture depends on how quick the machine is. Without a time it does not.
/// Errors: those of `make`; Interrupted, when `progress` says so.
RenderResult refine(const RefinementGoal& goal, const RenderParameters& parameters,
                    const RefinementSteps& steps, Progress& progress);

/// Relative standard error that the statistics of a picture state; 0 where none is known.
double standard_error_of(const RenderResult& picture);

}  // namespace photile
