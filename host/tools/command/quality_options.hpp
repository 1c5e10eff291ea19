// `--quality`, `--target-error` and `--time-budget`: settings by name, or chosen for a wanted error
// or frame time.
#pragma once

#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "tools/trade/quality_target.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds --quality, which sets several settings at once. To be added before theirs: options that are
/// given override it, wherever they stand on the line.
void add_quality_preset(CLI::App& command, RenderParameters& parameters);

/// Adds both options. They exclude the options whose values they choose, which must be there.
void add_quality_options(CLI::App& command, QualityTarget& target);

/// Whether the user asked for either.
bool is_wanted(const QualityTarget& target);

/// Measures the models on a view, sets what they choose in `parameters`, and tells the choice and
/// its reasons. Returns the cost of the measurement, with the expectations as figures.
/// Errors: those of measure_models.
StageStatistics choose_quality(const QualityTarget& target, const Scene& scene,
                               const Camera& camera, Device& device, const LightMix& mix,
                               RenderParameters& parameters, Progress& progress);

}  // namespace photile::app
