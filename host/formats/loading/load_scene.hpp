// A scene file with its options becomes a scene that knows where in the file each light comes from.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/value_range.hpp"
#include "files/scene_files.hpp"
#include "loading/luminaires.hpp"
#include "photile/load_scene.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "reading/area_lights.hpp"

namespace photile::loading {

inline constexpr Numbers turns{-360, 360};  ///< degrees of north, and of surroundings
inline constexpr Numbers reflectances{0, 1};

/// A scene with the source of each of its lights.
struct SourcedScene {
  Scene scene;
  std::vector<reading::LightSource> sources;
  std::vector<PlacedLuminaires> luminaires;  ///< of each entry of the list of luminaires
};

/// photile::load_scene, which keeps no sources and cannot be interrupted.
///   progress   is asked whether to go on
/// Errors: the same; Interrupted.
SourcedScene load_sourced_scene(const std::filesystem::path& file, const SceneLoadOptions& options,
                                const Progress& progress = Progress::none());

/// The scene alone.
Scene load_scene(const std::filesystem::path& file, const SceneLoadOptions& options,
                 const Progress& progress);

// The upward axis of a scene file: OBJ files do not state it, and some glTF files have it wrong.

/// The rotation after which `up` ("x" to "-z", "" = "y") points along y. With "z", as CAD programs
/// have it, x stays and the file's y becomes -z, north. Errors: UsageError for another word.
glm::dmat3 turn_upright(const std::string& up);

/// Warns where the triangles look as if z pointed up: the scene is at most as high along z as along
/// y, at least as high as a room (or, of small models, as half their width), and has twice as much
/// surface that faces along z as along y, or one plane along z twice as large as any along y, or
/// both a little less. A guess: an empty room 4 x 3 m wide and 2.8 m high is the same box as one 4
/// x 2.8 m wide and 3 m high, so nothing is turned.
void warn_of_other_up(const Scene& scene, files::Warnings& warnings);

// The unit of the lengths of a scene file: glTF requires metres, which many exporters ignore.

/// "mm", "cm", "m", "in" and "ft".
std::vector<std::string_view> names_of_units();
double metres_in(std::string_view unit);

/// Warns where the scene is wider than a hall or smaller than a cup, and names the units that would
/// make a room of it. A guess: nothing is scaled.
void warn_of_other_unit(const Scene& scene, files::Warnings& warnings);

}  // namespace photile::loading
