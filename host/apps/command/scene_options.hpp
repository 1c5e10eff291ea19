// How a scene file is read; every command that loads a scene has these options.
#pragma once

#include <string>

#include "photile/scene.hpp"

namespace CLI {
class App;
}

namespace photile::app {

/// Adds the options to a subcommand, in the help's group `group`.
void add_scene_options(CLI::App& command, SceneLoadOptions& options, const std::string& group);

/// Adds those that add lights to the scene or change them. Malformed ones are errors of the command
/// line.
void add_light_options(CLI::App& command, SceneLoadOptions& options, const std::string& group);

/// Adds --site, --time and --weather.
void add_situation_options(CLI::App& command, SkySituation& situation, const std::string& group);

}  // namespace photile::app
