#include "render/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "render/setting.hpp"

namespace photile {
namespace {

/// The first picture of those for a time has this part of the work.
constexpr double first_fraction = 0.25;

/// Twice the work leaves 0.7 of the error where it is noise, and more than this where it is not.
constexpr double stalled = 0.95;

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
  void warn(const std::string& line) override { to_.warn(line); }
  bool cancelled() const override { return to_.cancelled() || is_over(); }
  bool is_over() const { return seconds_ > 0 && elapsed_() >= seconds_; }

 private:
  Progress& to_;
  const std::function<double()>& elapsed_;
  double seconds_;
};

bool is_work(const Setting& setting) {
  return setting.is_of_quality() &&
         setting.by_quality[index_of(Quality::best)] > setting.by_quality[index_of(Quality::good)];
}

bool same_work(const RenderParameters& a, const RenderParameters& b) {
  return std::all_of(settings().begin(), settings().end(), [&](const Setting& setting) {
    return !is_work(setting) || setting.value(a) == setting.value(b);
  });
}

/// The error of the most work that settings allow, where it is noise.
double least_error(RenderParameters parameters, double error) {
  for (;;) {
    const RenderParameters more = with_work(parameters, 2);
    if (same_work(more, parameters)) return error;
    parameters = more;
    error /= std::sqrt(2.0);
  }
}

void tell_out_of_reach(double error, double floor, Progress& progress) {
  progress.note(
      fmt::format("a standard error of {:.3g}% is out of reach: about {:.2g}% is left however much "
                  "is done; the "
                  "picture is the best so far",
                  100 * error, 100 * floor));
}

}  // namespace

RenderParameters with_work(RenderParameters parameters, double factor) {
  for (const Setting& setting : settings()) {
    if (is_work(setting)) setting.set(parameters, scaled(setting, parameters, factor));
  }
  return parameters;
}

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
  RenderParameters next = goal.seconds > 0 ? with_work(parameters, first_fraction) : parameters;
  std::optional<RenderResult> best;
  double before = std::numeric_limits<double>::infinity();
  for (;;) {
    const double began = steps.elapsed();
    Deadline deadline(progress, steps.elapsed, best ? goal.seconds : 0);
    try {
      RenderResult picture = steps.make(next, deadline);
      if (!best || standard_error_of(picture) <= standard_error_of(*best)) {
        best = std::move(picture);
        steps.finished(next, *best);
      }
    } catch (const Interrupted&) {
      if (!best || progress.cancelled()) throw;
      progress.end();
      progress.note("the time is over; what was being made is given up");
      return std::move(*best);
    }
    const double now = steps.elapsed();
    const double error = standard_error_of(*best);
    if (goal.error > 0) {
      if (error <= goal.error) return std::move(*best);
      const double floor = error > stalled * before ? error : least_error(next, error);
      if (floor > goal.error) {
        tell_out_of_reach(goal.error, floor, progress);
        return std::move(*best);
      }
      before = error;
    }
    if (goal.seconds > 0 && goal.seconds - now < now - began) return std::move(*best);
    const RenderParameters more = with_work(next, 2);
    if (same_work(more, next)) return std::move(*best);
    next = more;
  }
}

}  // namespace photile
