// Options that say what is left to photons at the hits: --direct, --direct-rays and --final-gather.
#pragma once

#include "tools/command/render_options.hpp"

namespace photile::app {

/// Adds --direct and --direct-rays.
void add_direct_options(CLI::App& command, RenderOptions& options);

/// Adds --final-gather.
void add_final_gather_option(CLI::App& command, RenderOptions& options);

/// Sets the looks at lamps from each hit. Errors: UsageError for --final-gather with --direct
/// photons.
void apply_direct_words(RenderOptions& options);

}  // namespace photile::app
