// `--quality`, which sets several settings by one name, and `--target-error` and `--for`, which
// make pictures until one is good enough or the time is over.
#pragma once

#include <span>
#include <string_view>

#include "photile/renderer.hpp"
#include "render/refinement.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// A quality, and the settings that it sets.
struct QualityOptions {
  Quality& quality;
  RenderParameters& parameters;
};

/// An option that ends a series of pictures. It is not a setting: each picture has its own
/// settings.
struct GoalOption {
  std::string_view name;    ///< in records, "target_error"
  std::string_view option;  ///< "target-error"
  std::string_view type;    ///< "PERCENT" or "TIME"
  std::string_view help;
  double RefinementGoal::*value;  ///< a share, or seconds; 0 = not asked for
};
std::span<const GoalOption> goal_options();

inline constexpr std::string_view quality_help =
    "preset of photons, k, samples and rays of nodes; options given with it take precedence";

/// Sets a quality and the settings that it consists of.
void set_quality(const QualityOptions& options, Quality quality);

/// Adds --quality, which sets several settings at once. To be added before theirs: options that are
/// given override it, wherever they stand.
void add_quality_preset(CLI::App& command, const QualityOptions& options);

/// Adds --target-error and --for.
void add_goal_options(CLI::App& command, RefinementGoal& goal);

/// Errors: UsageError for a goal where nodes of light maps do not gather, since pictures state the
/// noise of such nodes.
void check_goal(const RefinementGoal& goal, const RenderParameters& parameters);

}  // namespace photile::app
