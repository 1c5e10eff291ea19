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
#include "render/quality.hpp"

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

/// Stops a picture when the time is over.
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

/// The error of the most work that settings allow, where it is noise.
double least_error(const RenderParameters& part, int parts, double error) {
  for (; allows_work(part, 2 * parts); parts *= 2) error /= std::sqrt(2.0);
  return error;
}

/// The work of all rounds that add up to `parts` parts, in proportion to their time.
double work_of(int parts) {
  const double photons = photons_of_parts(parts);
  return parts * std::pow(photons, power_of_nodes) + time_of_photons * photons;
}

/// The likely seconds of the next round, after one that took `seconds` and led to `parts` parts.
///   before   parts before that; 0 = none
double seconds_of_next(double seconds, int before, int parts) {
  const double work_before = before > 0 ? work_of(before) : 0;
  return seconds * (work_of(parts_after(parts)) - work_of(parts)) / (work_of(parts) - work_before);
}

void tell_out_of_reach(double error, double floor, Progress& progress) {
  progress.note(
      fmt::format("a standard error of {:.3g}% is out of reach: about {:.2g}% is left however much "
                  "is done; the "
                  "picture is the best so far",
                  100 * error, 100 * floor));
}

}  // namespace

RenderParameters first_part(const RefinementGoal& goal, const RenderParameters& asked) {
  if (goal.seconds == 0) return asked;
  RenderParameters part = with_work(asked, first_fraction);
  part.photons = asked.photons;
  return part;
}

RenderResult refine(const RefinementGoal& goal, const RenderParameters& part,
                    const RefinementSteps& steps, Progress& progress) {
  std::optional<RenderResult> latest;
  double before = std::numeric_limits<double>::infinity();
  int parts = 0, next = 1;
  for (;;) {
    const double began = steps.elapsed();
    Deadline deadline(progress, steps.elapsed, latest ? goal.seconds : 0);
    try {
      latest = steps.make(next - parts, deadline);
    } catch (const Interrupted&) {
      if (!latest || progress.cancelled()) throw;
      progress.end();
      progress.note("the time is over; what was being made is given up");
      return std::move(*latest);
    }
    const int parts_before = std::exchange(parts, next);
    steps.finished(parts, *latest);
    const double now = steps.elapsed(), error = latest->standard_error;
    if (goal.error > 0) {
      if (error <= goal.error) return std::move(*latest);
      const double floor = error > stalled * before ? error : least_error(part, parts, error);
      if (floor > goal.error) {
        tell_out_of_reach(goal.error, floor, progress);
        return std::move(*latest);
      }
      before = error;
    }
    const bool fits = goal.seconds == 0 || seconds_of_next(now - began, parts_before, parts) <=
                                               planned_part * (goal.seconds - now);
    next = parts_after(parts);
    if (!fits || !allows_work(part, next)) return std::move(*latest);
  }
}

}  // namespace photile
