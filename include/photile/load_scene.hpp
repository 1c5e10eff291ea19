// Scenes from files, and what may be changed while they are read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/light_options.hpp"
#include "photile/scene.hpp"

namespace photile {

/// The parts of a file that are loaded, and what is added to it or changed.
struct SceneLoadOptions {
  float emissive_scale = 1.0f;  ///< multiplies emissive radiance; 683 mends Blender files
  bool allow_outside = false;   ///< textures and buffers may lie outside the scene's folder
  /// Which of the scenes in a glTF file: name or index; "" = the file's default, else its first.
  std::string scene = {};
  /// Globs of what is left out: nodes of glTF with all below them, its meshes, objects and groups
  /// of OBJ.
  std::vector<std::string> hidden = {};
  /// Which axis of the file points up: "x", "y", "z", "-x", "-y" or "-z"; the scene is turned so
  /// that it becomes y. "" = y, and a warning where the geometry looks as if it were z.
  std::string up = {};
  /// Metres in a unit of the file's lengths: 0.001 where they are millimetres.
  double metres_per_unit = 1;
  std::vector<LightGrouping> light_groups = {};  ///< after the file's own; the last match counts
  std::vector<LightProfile> profiles = {};
  std::vector<LightTemperature> temperatures = {};
  std::vector<LuminousPanel> panels = {};
  EnvironmentPicture environment = {};
  std::optional<Sun> sun = std::nullopt;
  std::optional<Sky> sky = std::nullopt;
  /// Reflectance of even ground below the horizon, which the sun and the sky light; 0 = it is
  /// black.
  double ground = defaults::ground_reflectance;
  std::vector<ReflectanceChange> reflectances = {};
  bool lambertian = false;   ///< dielectrics have no specular lobe
  bool may_be_dark = false;  ///< no error where there is no light
  SkySituation situation = {};
  std::filesystem::path luminaires =
      {};  ///< luminaires to place, JSON (docs/luminaires.md); "" = none
  /// Text that replaces the content of that file while it is edited, "" = the file; a scene without
  /// any light then gets one.
  std::string luminaires_text = {};
  /// Windows for the light of suns and skies: "auto" finds them, "off" takes none, else globs of
  /// the names of materials that fill them.
  std::vector<std::string> portals = {};  ///< empty = auto
  /// Turns values in lumens or lux into the watts of an OBJ scene.
  double lumen_per_watt = defaults::lumen_per_watt;
};

/// Reads a scene from OBJ+MTL (.obj) or glTF 2.0 (.gltf, .glb).
/// Errors: InputError naming the file and the remedy when it is missing, unreadable, malformed,
/// beyond a limit of limits.hpp, without triangles or without lights; UsageError when `up` is no
/// axis, the file has no such scene, a grouping matches no light, a glob of `hidden` matches
/// nothing, or a group bears the name of a light outside it.
Scene load_scene(const std::filesystem::path& file, const SceneLoadOptions& options = {});

}  // namespace photile
