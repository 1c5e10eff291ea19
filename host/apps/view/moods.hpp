// Named moods: sets of lamp settings, kept in a JSON file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "photile/load_scene.hpp"
#include "view/light_board.hpp"

namespace photile::view {

/// Moods of one scene by name. The file:
///
///     {"photile_moods": 1,
///      "moods": {"evening": {"ceiling": {"power": 200, "unit": "lm", "on": true},
///                            "floor lamp": {"power": 800, "unit": "lm", "on": true,
///                                           "color": "#ffd9a0"}}}}
///
/// In place of a colour there may be its temperature, "kelvin": 2700. What a mood does not name, a
/// light or its power, stays as it is: {"on": false} alone is a setting.
class Moods {
 public:
  /// Reads the file; a missing one holds no moods yet. Errors: InputError naming the file and what
  /// is wrong.
  explicit Moods(std::filesystem::path file);

  /// Beside the scene: room.gltf has room.moods.json.
  static std::filesystem::path file_of(const std::filesystem::path& scene);

  std::vector<std::string> names() const;

  /// Keeps the board's settings under a name and writes the file, through a temporary name and a
  /// rename; powers have four digits there. Errors: OutputError; the file is then as it was.
  void keep(const std::string& name, const LightBoard& board);
  void remove(const std::string& name);  ///< errors: as keep

  /// Sets the board. Errors: UsageError when there is no such mood, or when it names a light that
  /// the board lacks, after it has set all others; it lists what there is.
  void apply(const std::string& name, LightBoard& board) const;

  /// What a mood asks of the lights of a mix, for change_lights. Errors: as apply.
  std::vector<LightChange> changes(const std::string& name, const LightMix& mix) const;

  const std::filesystem::path& file() const { return file_; }

 private:
  struct Setting {
    std::optional<double> power;
    PowerUnit unit;
    bool on;
    std::optional<glm::vec3> color;
    double kelvin = 0;
  };
  using Mood = std::map<std::string, Setting>;  ///< by light

  const Mood& named(const std::string& name) const;
  void refuse_unknown_lights(const std::string& name, const std::vector<std::string>& there) const;
  void write(const std::map<std::string, Mood>& moods) const;

  std::filesystem::path file_;
  std::map<std::string, Mood> moods_;
};

/// A copy of the scene's file with its lamps in a mood. Returns a message: the name of the file and
/// what could not be written, or what failed.
std::string write_mood(const Scene& scene, const SceneLoadOptions& load, LightBoard board,
                       const Moods& moods, const std::string& mood);

}  // namespace photile::view
