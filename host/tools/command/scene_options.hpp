// How a scene file is read; every command that loads a scene has these options.
#pragma once

#include <string>

#include "photile/scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds the options to a subcommand, in the help's group `group`; those that add or change lights
/// are in added_light_options.hpp.
void add_scene_options(CLI::App& command, SceneLoadOptions& options, const std::string& group);

}  // namespace photile::app
