// What the importers share while they fill a scene.
#pragma once

#include <string>
#include <vector>

#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "scene/area_lights.hpp"
#include "scene/scene_folder.hpp"
#include "scene/warnings.hpp"

namespace photile::scene_io {

struct ImportContext {
  Scene& scene;
  SceneFolder& folder;
  const SceneLoadOptions& options;
  Warnings& warnings;
  AreaLights& area_lights;
  std::vector<Emission> emission;  ///< per material of `scene`

  /// An error about the scene file; `message` says what was found and the remedy.
  InputError error(const std::string& message) const {
    return InputError(folder.scene_file().string() + ": " + message);
  }
};

}  // namespace photile::scene_io
