// Small scenes at random: most are sound, some are extreme, some are broken.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dice.hpp"

namespace photile::test {

struct RandomScene {
  std::filesystem::path file;
  std::vector<std::filesystem::path> inputs;  ///< it and the files that it names
  std::vector<std::string> lights;            ///< names that are likely to be there
  double size = 1;                            ///< metres, about
  bool sound = true;                          ///< lit, of usual size and powers, and not damaged
  bool opaque_room = true;                    ///< its walls are neither glass nor mirrors
};

/// Writes a scene into the folder: a room with up to four lamps and a few things in it, as OBJ or
/// as glTF.
RandomScene write_random_scene(const std::filesystem::path& folder, Dice& dice);

}  // namespace photile::test
