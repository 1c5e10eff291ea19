#include "render/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

/// With a time, the first picture has this part of what is asked.
constexpr double first_share = 0.25;
/// A picture with so many times the photons and rays takes the time to this power: there are more
/// nodes, too (bench/clean_pictures.py).
constexpr double time_power = 1.7;
/// Of the time that is left: what a picture is expected to take.
constexpr double used_share = 0.8;
/// Pictures that are better by less are not worth their time.
constexpr double least_factor = 1.25;
/// The error of the next picture is known too little for more.
constexpr double most_factor = 8;
/// More than the error asks for, since it is not known exactly.
constexpr double error_margin = 1.1;

/// Stops a picture that the time is over for.
class Deadline : public Progress {
 public:
  Deadline(Progress& to, const std::function<double()>& elapsed, double seconds)
      : to_(to), elapsed_(elapsed), seconds_(seconds) {}
  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override {
    to_.begin(stage, total, unit);
  }
  void advance(std::uint64_t count) override { to_.advance(count); }
  void end() override { to_.end(); }
  void note(const std::string& line) override { to_.note(line); }
  bool cancelled() const override { return to_.cancelled() || is_over(); }
  bool is_over() const { return seconds_ > 0 && elapsed_() >= seconds_; }

 private:
  Progress& to_;
  const std::function<double()>& elapsed_;
  double seconds_;
};

RenderParameters scaled(RenderParameters parameters, double factor) {
  const auto times = [&](double value, double least, double most) {
    return std::clamp(std::round(factor * value), least, most);
  };
  parameters.photons.emitted_photons = static_cast<std::uint64_t>(times(
      static_cast<double>(parameters.photons.emitted_photons),
      static_cast<double>(limits::min_photons), static_cast<double>(limits::max_emitted_photons)));
  parameters.light_map_rays = static_cast<int>(
      times(parameters.light_map_rays, 1, static_cast<double>(limits::max_gathering_rays)));
  return parameters;
}

bool same_effort(const RenderParameters& a, const RenderParameters& b) {
  return a.photons.emitted_photons == b.photons.emitted_photons &&
         a.light_map_rays == b.light_map_rays;
}

/// What the next picture should have more; below least_factor: there is none.
double next_factor(const RefinementGoal& goal, double error, double took, double left) {
  double factor = most_factor;
  if (goal.error > 0) {
    if (error <= goal.error) return 0;
    factor =
        std::min(factor, std::max(least_factor, error_margin * std::pow(error / goal.error, 2)));
  }
  if (goal.seconds > 0) {
    factor = std::min(factor, std::pow(used_share * std::max(0.0, left) / took, 1 / time_power));
  }
  return factor;
}

}  // namespace

double standard_error_of(const RenderResult& picture) {
  for (const StageStatistics& stage : picture.statistics) {
    for (const auto& [name, value] : stage.figures) {
      if (name == "standard error percent") return value / 100;
    }
  }
  return 0;
}

RenderResult refine(const RefinementGoal& goal, const RenderParameters& parameters,
                    const RefinementSteps& steps, Progress& progress) {
  RenderParameters next = goal.seconds > 0 ? scaled(parameters, first_share) : parameters;
  std::optional<RenderResult> best;
  for (;;) {
    const double began = steps.elapsed();
    Deadline deadline(progress, steps.elapsed, best ? goal.seconds : 0);
    try {
      best = steps.make(next, deadline);
    } catch (const Interrupted&) {
      if (!best || progress.cancelled()) throw;
      progress.end();
      progress.note("the time is over; the next picture is given up");
      return std::move(*best);
    }
    steps.finished(*best);
    const double now = steps.elapsed();
    const double took = std::max(now - began, 1e-6);
    const double factor = next_factor(goal, standard_error_of(*best), took, goal.seconds - now);
    if (factor < least_factor) return std::move(*best);
    const RenderParameters more = scaled(next, factor);
    if (same_effort(more, next)) return std::move(*best);
    next = more;
  }
}

}  // namespace photile
