// Measured lamps that a user places: their luminous openings emit from their true area.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "files/scene_files.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"

namespace photile::loading {

/// Members keep their order and their numbers: what is not edited is written as it was read.
/// Their meaning is read by add_luminaires.
struct LuminaireList {
  std::vector<nlohmann::ordered_json> entries;
  bool alone = false;  ///< one object in place of a list

  bool operator==(const LuminaireList&) const = default;

  /// JSON, an entry a line.
  std::string text() const;

  ///   name   of the file, for messages
  /// Errors: InputError where it is no JSON, or neither an object nor a list.
  static LuminaireList parse(const std::string& text, const std::string& name);
};

/// Errors: those of parse and read_input_text.
LuminaireList read_luminaires(const std::filesystem::path& file);
/// Reads a list from a file that the run may write; one that does not exist holds no entry yet.
LuminaireList read_own_luminaires(const std::filesystem::path& file);

/// Through a temporary name and a rename. Errors: OutputError; the file is then as it was.
void write_luminaires(const std::filesystem::path& file, const LuminaireList& list);

/// Where the lamps of an entry are, in the scene's coordinates.
struct PlacedLuminaires {
  std::string name;
  glm::dvec3 position{0.0};  ///< of their middle
  /// x, y and z of each: the opening lies in x and y, and shines along -z.
  glm::dmat3 axes{1.0};
  double rotation = 0;        ///< radians, of x about the aim
  glm::dvec2 opening{0.0};    ///< metres along x and y
  int columns = 1, rows = 1;  ///< along x and y
  glm::dvec2 spacing{0.0};    ///< metres
  double lumens = 0;          ///< of each lamp
  double kelvin = 0;          ///< of its light; 0 = neutral white
  std::string circuit;        ///< "" = lamps of other entries are not switched with these

  std::vector<glm::dvec3> middles() const;
};

/// x, y and z of a lamp with an aim: not rotated, x lies in the horizon, along that of the world
/// where it shines up or down.
///   aim        unit
///   rotation   radians
glm::dmat3 luminaire_axes(const glm::dvec3& aim, double rotation);

/// The size that an entry with this photometric file has without `size`; nothing where the file
/// states none. Errors: InputError, ResourceError.
std::optional<glm::dvec2> stated_opening(const std::filesystem::path& photometry);

/// Adds lamps to a scene with its triangles and area lights: for each a flat opening that shines by
/// the intensities of its photometric file. docs/guide/luminaires.md has the members of an entry.
/// Returns where each entry's are.
///   file            of the list, for messages and for the folder of photometric files
///   allow_outside   photometric files outside this folder may be read, too
/// Errors: InputError naming the file, the entry and the member.
std::vector<PlacedLuminaires> add_luminaires(const LuminaireList& list,
                                             const std::filesystem::path& file, bool allow_outside,
                                             double lumen_per_watt, Scene& scene,
                                             files::Warnings& warnings);

/// What add_luminaires makes of the options: of their file, or of the text in its place.
std::vector<PlacedLuminaires> add_luminaires(const SceneLoadOptions& options, Scene& scene,
                                             files::Warnings& warnings);

}  // namespace photile::loading
