// `--quality`, `--target-error`, `--time-budget` and `--for`: settings by name, or chosen for a
// wanted error or time.
#pragma once

#include <functional>

#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "render/quality.hpp"
#include "tools/trade/quality_target.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds --quality, which sets several settings at once; `usual` is what the parameters have without
/// it. To be added before theirs: options that are given override it, wherever they stand.
void add_quality_preset(CLI::App& command, RenderParameters& parameters, Quality usual);

/// Adds --time-budget, whose models know the quality draft alone. To be added before the settings,
/// too.
void add_time_budget(CLI::App& command, QualityTarget& target, RenderParameters& parameters);

/// Adds the other options of a target. All exclude the options whose values they choose, which must
/// be there.
void add_quality_options(CLI::App& command, QualityTarget& target);

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
