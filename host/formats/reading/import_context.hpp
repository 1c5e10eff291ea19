// What the readers of scene files share while they fill a scene.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "files/scene_files.hpp"
#include "photile/errors.hpp"
#include "photile/load_scene.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"

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
  const Progress& progress = Progress::none();    ///< that may ask to stop

  /// An error about the scene file; `message` says what was found and the remedy.
  InputError error(const std::string& message) const {
    return InputError(folder.scene_file().string() + ": " + message);
  }

  /// To be called for each line, triangle and the like: checks now and then whether the user asked
  /// to stop. Errors: Interrupted.
  void check_cancelled() {
    constexpr std::uint32_t calls_between_checks = 1024;
    if (++calls_ % calls_between_checks == 0) progress.throw_if_cancelled();
  }
  std::uint32_t calls_ = 0;  ///< of check_cancelled

  /// Whether SceneLoadOptions::hidden leaves out what has this name.
  bool is_hidden(const std::string& name);

  /// To be called once all names are known. Errors: UsageError that names a glob without a match.
  void check_hidden() const;
  std::vector<bool> has_hidden_ = {};  ///< per glob: whether it had a match
};

/// Whether some material's emission has a texture.
inline bool has_emission_texture(const ImportContext& context) {
  return std::any_of(context.emission.begin(), context.emission.end(),
                     [](const Emission& emission) { return emission.texture != none; });
}

/// Materials as surfaces without texture coordinates have them: mid grey in place of a base-colour
/// texture, as where its file is missing, the factors alone in place of all others, and no normal
/// map.
class PlainMaterials {
 public:
  explicit PlainMaterials(Scene& scene) : scene_(scene) {}

  /// The one that stands in for `material` of the scene; it is added when it is first asked for,
  /// and named after it.
  std::uint32_t of(std::uint32_t material);

 private:
  Scene& scene_;
  std::map<std::uint32_t, std::uint32_t> index_;
};

}  // namespace photile::reading
