// --light-group, which every command that loads a scene has.
#pragma once

#include "photile/scene.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace photile::app {

/// Adds --light-group, repeatable, to a subcommand. Malformed ones are errors of the command line.
CLI::Option* add_light_group_option(CLI::App& command, SceneLoadOptions& options);

}  // namespace photile::app
