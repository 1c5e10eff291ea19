#include "render/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "common/stoppable_progress.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/quality.hpp"
#include "render/render_plan.hpp"

namespace photile {
namespace {

/// Of the rays and samples, where a time is given.
constexpr double first_fraction = 0.25;

/// A round leaves 0.71 to 0.87 of an error that is noise, and more than this of one that is not.
constexpr double stalled = 0.97;

/// The part of the time left that a round is planned to take. The rest allows for what the plan
/// cannot predict, such as other programs.
constexpr double planned_part = 0.9;

/// The number of nodes is in proportion to this power of the number of photons, because nodes lie
/// closer together with more photons: with four times the work, `--quality final` takes five to
/// seven times as long as `good`.
constexpr double power_of_nodes = 0.5;

/// The time of the photons of a part over that of its rays.
constexpr double time_of_photons = 0.5;

/// The error of the most work that is allowed, where it is noise.
double least_error(int parts, int most_parts, double error) {
  for (; parts <= most_parts / 2; parts *= 2) error /= std::sqrt(2.0);
  return error;
}

}  // namespace

double work_of_pictures(int parts) {
  const double photons = parts > 0 ? photons_of_parts(parts) : 0;
  return parts * std::pow(photons, power_of_nodes) + time_of_photons * photons;
}

double refine(const RefinementGoal& goal, const RefinementSteps& steps, Progress& progress) {
  double error = std::numeric_limits<double>::infinity();
  for (int parts = 0, next = 1;;) {
    const double began = steps.elapsed(), error_before = error;
    const bool may_end = parts >= goal.parts;
    StoppableProgress deadline(
        progress, [&] { return may_end && goal.seconds > 0 && steps.elapsed() >= goal.seconds; });
    try {
      error = steps.add(next - parts, deadline);
    } catch (const Interrupted&) {
      if (!may_end || progress.cancelled()) throw;
      progress.end();
      progress.note("the time is up; unfinished work is discarded");
      return error;
    }
    const int parts_before = std::exchange(parts, next);
    steps.finished(parts, error);
    next = steps.next(parts);
    if (parts < goal.parts) {
      next = std::min(next, goal.parts);
      continue;
    }
    if (!goal.is_given()) return error;
    if (goal.error > 0) {
      if (error <= goal.error) return error;
      const double floor =
          error > stalled * error_before ? error : least_error(parts, steps.most_parts, error);
      if (floor > goal.error) {
        progress.note(
            fmt::format("a standard error of {:.3g}% cannot be reached: about {:.2g}% remains "
                        "however many rays are added; the picture is the best so far",
                        100 * goal.error, 100 * floor));
        return error;
      }
    }
    const double now = steps.elapsed(), work = steps.work(parts);
    const double of_next =
        (now - began) * (steps.work(next) - work) / (work - steps.work(parts_before));
    const bool fits = goal.seconds == 0 || of_next <= planned_part * (goal.seconds - now);
    if (!fits || next > steps.most_parts) return error;
  }
}

bool in_parts(const RenderParameters& asked) {
  return asked.light_maps == LightMapMode::on && asked.passes > 1 && nodes_gather(asked);
}

RenderParameters of_parts(const RenderParameters& part, int parts) {
  RenderParameters all = with_work(part, parts);
  all.photons.emitted_photons = part.photons.emitted_photons * photons_of_parts(parts);
  if (parts > 1) {
    all.passes = parts;
    all.light_maps = LightMapMode::on;
  }
  return all;
}

RenderParameters part_of(const RenderParameters& all) {
  RenderParameters part = with_work(all, 1.0 / all.passes);
  part.photons.emitted_photons =
      std::max<std::uint64_t>(1, all.photons.emitted_photons / photons_of_parts(all.passes));
  part.light_map_rays = std::max(1, part.light_map_rays);
  part.passes = 1;
  return part;
}

RenderParameters first_part(const RefinementGoal& goal, const RenderParameters& asked) {
  if (goal.seconds == 0) return asked;
  RenderParameters part = with_work(asked, first_fraction);
  part.photons = asked.photons;
  return part;
}

}  // namespace photile
