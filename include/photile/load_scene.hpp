// Scenes from files, and what may be changed while they are read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/scene.hpp"

namespace photile {

/// Puts lights into a group.
struct LightGrouping {
  std::string glob;   ///< of light names: *, ? and [...] as in a shell
  std::string group;  ///< cleaned as light names are
  /// Splits at the last '='. Errors: UsageError when `text` has no '=' or an empty side.
  static LightGrouping parse(const std::string& text);
};

/// Gives a point or spot light of the scene the intensities of a photometric file.
struct LightProfile {
  std::string light;
  std::filesystem::path file;  ///< LM-63 (.ies) or EULUMDAT (.ldt)
  /// Splits at the first '='. Errors: UsageError.
  static LightProfile parse(const std::string& text);
};

/// Surroundings from a picture.
struct EnvironmentPicture {
  std::filesystem::path file;   ///< "" = none
  double scale = 1;             ///< multiplies the texels, which are cd/m2 or W/(m2 sr)
  double rotation_degrees = 0;  ///< clockwise as seen from above
};

/// A site on Earth; parsed from LATITUDE,LONGITUDE,TIME_ZONE.
struct Site {
  double latitude_degrees = 0;   ///< north of the equator
  double longitude_degrees = 0;  ///< east of Greenwich
  double time_zone = 0;          ///< hours ahead of UTC: 1 in Berlin, -5 in New York
  /// Errors: UsageError unless there are three numbers in range.
  static Site parse(const std::string& text);
};

/// A moment of the site's standard time; parsed from YYYY-MM-DDTHH:MM.
struct LocalTime {
  int year = 2026, month = 1, day = 1;
  double hour = 12;  ///< from midnight, in [0, 24)
  /// Errors: UsageError for another form, or a day that does not exist.
  static LocalTime parse(const std::string& text);
};

/// The data that the position of the sun and the luminance of the sky follow from.
struct SkySituation {
  std::optional<Site> site = std::nullopt;  ///< if not given, that of the weather file
  std::optional<LocalTime> time = std::nullopt;
  double north_degrees = 0;            ///< of north, clockwise from -z as seen from above
  std::filesystem::path weather = {};  ///< an EPW file, "" = none
};

/// The sun; parsed from AZIMUTH,ELEVATION,LUX, or from LUX alone where a time gives the position.
struct Sun {
  double azimuth_degrees = 0;    ///< clockwise from north, which is -z; east is +x
  double elevation_degrees = 0;  ///< above the horizon, y upwards
  double illuminance = 0;        ///< lux on a surface that faces it
  double diameter_degrees = defaults::sun_diameter_degrees;  ///< of its disc; 0 = parallel light
  bool placed_by_time = false;  ///< azimuth and elevation are those of SkySituation
  /// Errors: UsageError unless there are three numbers in range.
  static Sun parse(const std::string& text);
};

enum class SkyKind {
  uniform,   ///< the same luminance everywhere
  overcast,  ///< CIE overcast sky: three times as bright at the zenith as at the horizon
  clear,     ///< CIE standard clear sky (ISO 15469, type 12); it needs a sun
  perez,     ///< all-weather sky of Perez, Seals and Michalsky (1993); it needs a sun
  patches    ///< even patches of 1 cd/m2, each a separate light, for relighting by time
};

/// The upper half of the surroundings, black below the horizon.
struct Sky {
  SkyKind kind = SkyKind::overcast;
  double illuminance = 0;    ///< lux on a horizontal surface that sees all of it, without the sun
  double direct_normal = 0;  ///< W/m2 on a surface that faces the sun, of a Perez sky
  double diffuse_horizontal = 0;  ///< W/m2 on a horizontal surface, of a Perez sky
  int patches = 0;                ///< 145, 577 or 2305
  /// Errors: UsageError.
  static Sky parse(const std::string& text);
};

/// A luminous rectangle at a node of a glTF file; parsed from NAME=WxH,LUMENS.
struct LuminousPanel {
  std::string node;
  double width = 0, height = 0;  ///< metres, along the node's x and y axes; it shines along -z
  double lumens = 0;
  /// Splits at the last '='. Errors: UsageError.
  static LuminousPanel parse(const std::string& text);
};

/// The fraction of light that materials reflect or transmit; parsed from MATERIAL=SHARE.
struct MaterialShare {
  std::string glob;     ///< of material names: *, ? and [...] as in a shell
  double fraction = 0;  ///< 0 to 1
  /// Splits at the last '='. SHARE is 0.5 or 50%. Errors: UsageError.
  static MaterialShare parse(const std::string& text);
};

/// The colour of a light by its temperature; parsed from NAME=KELVIN.
struct LightTemperature {
  std::string light;
  double kelvin = 0;
  /// Splits at the last '='. Errors: UsageError.
  static LightTemperature parse(const std::string& text);
};

/// The parts of a file that are loaded, and what is added to it or changed.
struct SceneLoadOptions {
  float emissive_scale = 1.0f;  ///< multiplies emissive radiance; 683 corrects Blender files
  bool allow_outside = false;   ///< textures and buffers may lie outside the scene's folder
  /// Which of the scenes in a glTF file: name or index; "" = the file's default, else its first.
  std::string scene = {};
  /// Globs of what is left out: nodes of glTF with all nodes below them, meshes of glTF, objects
  /// and groups of OBJ.
  std::vector<std::string> hidden = {};
  /// Which axis of the file points up: "x", "y", "z", "-x", "-y" or "-z"; the scene is turned so
  /// that it becomes y. "" = y, and a warning where the geometry looks as if it were z.
  std::string up = {};
  /// Metres per unit of the file's lengths: 0.001 for millimetres.
  double metres_per_unit = 1;
  std::vector<LightGrouping> light_groups = {};  ///< after the file's own; the last match applies
  std::vector<LightProfile> profiles = {};
  std::vector<LightTemperature> temperatures = {};
  std::vector<LuminousPanel> panels = {};
  EnvironmentPicture environment = {};
  std::optional<Sun> sun = std::nullopt;
  std::optional<Sky> sky = std::nullopt;
  /// Reflectance of even ground below the horizon, which the sun and the sky light; 0 = black.
  double ground = defaults::ground_reflectance;
  /// Luminous reflectances, of light from all directions.
  std::vector<MaterialShare> reflectances = {};
  /// Materials that become clear glass, with its transmittance at normal incidence: through both
  /// faces of a pane that is modelled with two.
  std::vector<MaterialShare> glasses = {};
  bool lambertian = false;   ///< dielectrics have no specular lobe
  bool may_be_dark = false;  ///< no error where there is no light
  SkySituation situation = {};
  std::filesystem::path luminaires =
      {};  ///< luminaires to place, JSON (docs/guide/luminaires.md); "" = none
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
/// beyond a limit of limits.hpp, without triangles or without lights; UsageError when `up` is not
/// an axis, the file has no such scene, a grouping matches no light, a glob of `hidden` matches
/// nothing, or a group has the name of a light outside it.
Scene load_scene(const std::filesystem::path& file, const SceneLoadOptions& options = {});

}  // namespace photile
