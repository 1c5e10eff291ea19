#include "command/quality_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "command/option_group.hpp"
#include "command/setting_options.hpp"
#include "photile/errors.hpp"
#include "render/render_plan.hpp"

namespace photile::app {

std::span<const GoalOption> goal_options() {
  static constexpr std::array<GoalOption, 2> options{{
      {"target_error", "target-error", "PERCENT",
       "add rays, photons and samples until the estimated relative error of the picture (root mean "
       "square) is at most this",
       &RefinementGoal::error},
      {"for", "for", "TIME",
       "add rays, photons and samples for this time, starting with a quarter; the picture then "
       "depends on the machine",
       &RefinementGoal::seconds},
  }};
  return options;
}

void set_quality(const QualityOptions& options, Quality quality) {
  options.quality = quality;
  photile::set_quality(options.parameters, quality);
}

void add_quality_preset(CLI::App& command, const QualityOptions& options) {
  OptionGroup(command, "Picture")
      .choose("--quality", all_qualities, options.quality, std::string(quality_help),
              [options](Quality quality) { set_quality(options, quality); });
}

void add_goal_options(CLI::App& command, RefinementGoal& goal) {
  for (const GoalOption& option : goal_options()) {
    OptionGroup(command, "Quality")
        .add(fmt::format("--{}", option.option), goal.*option.value, std::string(option.type),
             std::string(option.help), option.type == "TIME" ? duration() : share_up_to(1));
  }
}

void check_goal(const RefinementGoal& goal, const RenderParameters& parameters) {
  if (nodes_gather(parameters)) return;
  for (const GoalOption& option : goal_options()) {
    if (!(goal.*option.value > 0)) continue;
    throw UsageError(
        fmt::format("--{}: errors are known only where nodes of light maps gather light by rays, "
                    "as with --quality good",
                    option.option));
  }
}

}  // namespace photile::app
