// A scene that remembers where in its file each light comes from, for those who edit lights.
#pragma once

#include <filesystem>
#include <vector>

#include "loading/luminaires.hpp"
#include "photile/scene.hpp"
#include "reading/light_source.hpp"

namespace photile::loading {

/// A scene with the source of each of its lights.
struct SourcedScene {
  Scene scene;
  std::vector<reading::LightSource> sources;
  std::vector<PlacedLuminaires> luminaires;  ///< of each entry of the list of luminaires
};

/// load_scene, which keeps no sources. Errors: the same.
SourcedScene load_sourced_scene(const std::filesystem::path& file, const SceneLoadOptions& options);

}  // namespace photile::loading
