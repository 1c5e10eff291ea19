// `photile render --glare`: the picture with its unwanted reflections marked.
#pragma once

#include "photile/light_layers.hpp"
#include "photile/light_mix.hpp"
#include "photile/progress.hpp"
#include "tools/command/render_options.hpp"

namespace photile::app {

/// Writes the file that --glare names, and tells what is marked. `reflections` are the part of
/// `layers` that came by reflection. Errors: OutputError.
void write_glare(const RenderOptions& options, const LightLayers& layers,
                 const LightLayers& reflections, const LightMix& mix, Progress& progress);

}  // namespace photile::app
