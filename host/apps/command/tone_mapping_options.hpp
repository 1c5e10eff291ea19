// The options that say how bright a picture is shown, and through which display transform.
#pragma once

#include <string>

#include "photile/image.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds --view.
void add_view_option(CLI::App& command, DisplayView& view, const std::string& group);

/// Adds --exposure and --view.
void add_tone_mapping_options(CLI::App& command, ToneMapping& parameters, const std::string& group);

}  // namespace photile::app
