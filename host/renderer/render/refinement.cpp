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

/// The part of the time left that a picture is planned to take. The rest is for what the plan does
/// not know, such as other programs.
constexpr double planned_part = 0.8;

/// Less would not show. A picture of so much is tried where less is planned, for nothing is lost.
constexpr double least_growth = 1.4;

/// More would make a user wait long for the next picture, and saves little: one of an eighth of the
/// work takes about a tenth of the time.
constexpr double most_growth = 8;

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

/// Work that leaves `error` times `from`, as a power of two, so that rounding on one device or
/// another does not change the settings: the error falls with the square root of work.
double growth_for_error(double from, double error) {
  return std::exp2(std::max(1.0, std::ceil(2 * std::log2(from / error))));
}

/// How many times the work of the last picture fits in a time. Time grows as a power of work, which
/// the last two pictures tell. Before that it is taken as 1.6: less noise divides light maps more
/// finely, so that four times the work took up to seven times as long (docs/quality.md), while much
/// that does not grow made it less than four times in scenes of many lights.
class TimePlan {
 public:
  /// A picture of `growth` times the work of the one before took so long.
  void add(double growth, double seconds) {
    if (seconds_ > 0)
      power_ = std::clamp(std::log(seconds / seconds_) / std::log(growth), 0.5, 2.0);
    seconds_ = seconds;
  }
  double growth_within(double seconds) const { return std::pow(seconds / seconds_, 1 / power_); }

 private:
  double power_ = 1.6;
  double seconds_ = 0;  ///< of the last picture
};

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
  TimePlan plan;
  double growth = 1;
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
    plan.add(growth, now - began);
    growth = most_growth;
    const double error = standard_error_of(*best);
    if (goal.error > 0) {
      if (error <= goal.error) return std::move(*best);
      const double floor = error > stalled * before ? error : least_error(next, error);
      if (floor > goal.error) {
        tell_out_of_reach(goal.error, floor, progress);
        return std::move(*best);
      }
      before = error;
      growth = std::min(growth, growth_for_error(error, goal.error));
    }
    if (goal.seconds > 0) {
      const double left = goal.seconds - now;
      if (left < now - began) return std::move(*best);
      growth = std::min(growth, std::max(least_growth, plan.growth_within(planned_part * left)));
    }
    const RenderParameters more = with_work(next, growth);
    if (same_work(more, next)) return std::move(*best);
    next = more;
  }
}

}  // namespace photile
