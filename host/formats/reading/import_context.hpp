// What the readers of scene files share while they fill a scene.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "files/scene_folder.hpp"
#include "files/warnings.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"
#include "reading/light_source.hpp"

namespace photile::reading {

struct ImportContext {
  Scene& scene;
  files::SceneFolder& folder;
  const SceneLoadOptions& options;
  files::Warnings& warnings;
  AreaLights& area_lights;
  std::vector<Emission> emission;                 ///< per material of `scene`
  std::vector<std::uint32_t> visited_nodes = {};  ///< of a glTF file, in the order of visits
  std::vector<LightSource> light_sources = {};    ///< of the lights of `scene` so far

  /// An error about the scene file; `message` says what was found and the remedy.
  InputError error(const std::string& message) const {
    return InputError(folder.scene_file().string() + ": " + message);
  }
};

/// Whether some material's emission has a texture.
inline bool has_emission_texture(const ImportContext& context) {
  return std::any_of(context.emission.begin(), context.emission.end(),
                     [](const Emission& emission) { return emission.texture != none; });
}

}  // namespace photile::reading
