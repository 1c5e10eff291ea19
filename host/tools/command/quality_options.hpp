// `--quality`, `--target-error`, `--time-budget` and `--for`: settings by name, or chosen for a
// wanted error or time.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "photile/renderer.hpp"
#include "photile/settings.hpp"
#include "photile/statistics.hpp"
#include "tools/trade/quality_target.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// What is asked for of quality, and the settings that follow.
struct QualityOptions {
  Quality& quality;
  QualityTarget& target;
  RenderParameters& parameters;
};

/// A row of what can be asked for beside the settings: an option that is no setting, because
/// settings are chosen for it.
struct QualityWish {
  std::string_view name;    ///< in records, "target_error"
  std::string_view option;  ///< "target-error"
  std::string_view type;    ///< "PERCENT" or "TIME"
  std::string_view help;
  double QualityTarget::*value;  ///< a share, or seconds; 0 = not asked for
};
std::span<const QualityWish> quality_wishes();

inline constexpr std::string_view quality_help =
    "photons, k, samples and rays of nodes together; options given beside it count";

/// Sets a quality and what it is made of.
void set_quality(const QualityOptions& options, Quality quality);

/// Adds --quality, which sets several settings at once. To be added before theirs: options that are
/// given override it, wherever they stand.
void add_quality_preset(CLI::App& command, const QualityOptions& options);

/// Adds the wishes. To be added before the settings, too: --time-budget stands for the quality
/// draft, which its model knows alone.
void add_quality_wishes(CLI::App& command, const QualityOptions& options);

/// Has the wishes exclude the options whose values they choose, which must be there.
void exclude_chosen(CLI::App& command);

/// Whether settings are to be chosen by the models.
bool is_wanted(const QualityTarget& target);

/// Whether pictures are made until one is good enough, or the time is over. Errors: UsageError for
/// a time where nodes of light maps do not gather.
bool refines(const QualityTarget& target, const RenderParameters& parameters);

/// `refine` by these functions, with a note about each picture.
///   elapsed   since the process began, seconds
RenderResult render_refined(
    const QualityTarget& target, const RenderParameters& parameters,
    const std::function<RenderResult(const RenderParameters&, Progress&)>& make,
    const std::function<void(const RenderResult&)>& finished,
    const std::function<double()>& elapsed, Progress& progress);

/// Measures the models on a view, sets what they choose in `parameters`, and tells the choice and
/// its reasons. Returns the cost of the measurement, with the expectations as figures.
/// Errors: those of measure_models.
StageStatistics choose_quality(const QualityTarget& target, const Scene& scene,
                               const Camera& camera, Device& device, const LightMix& mix,
                               RenderParameters& parameters, Progress& progress);

}  // namespace photile::app
