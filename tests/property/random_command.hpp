// Commands at random: options from the table of settings and from those of each subcommand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "random_scene.hpp"

namespace photile::test {

struct RandomCommand {
  std::vector<std::string> arguments;          ///< without the program's name
  std::vector<std::filesystem::path> inputs;   ///< files that it may read
  std::vector<std::filesystem::path> outputs;  ///< files, or folders, that it is to write
  bool timed = false;                          ///< what comes out depends on the time it takes
};

/// What commands work on.
struct Workplace {
  RandomScene scene;
  std::filesystem::path folder;   ///< of outputs
  std::filesystem::path picture;  ///< with layers, from an earlier render
  bool any_kernel;  ///< else few programs are asked for, since each takes seconds to compile
};

/// One that takes a fraction of a second. The same dice give the same arguments, but for folders.
RandomCommand random_command(const Workplace& place, Dice& dice);

}  // namespace photile::test
