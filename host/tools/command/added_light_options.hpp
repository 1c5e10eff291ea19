// Options that add lights to a scene or change them while it is loaded; every command that loads a
// scene has them.
#pragma once

#include <string>

#include "photile/scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds the options to a subcommand, in the help's group `group`. Malformed ones are errors of the
/// command line.
void add_light_options(CLI::App& command, SceneLoadOptions& options, const std::string& group);

}  // namespace photile::app
