// A file of luminaires while it is edited: the positions of luminaires, which one is selected, and
// what was changed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loading/luminaires.hpp"

namespace photile::view {

/// Entries of the file, and where their lamps are: an edit moves these at once, the scene follows
/// when it is loaded again (scene_loader.hpp).
class LuminaireEditor {
 public:
  ///   file     that `save` writes; it may not exist yet
  ///   placed   as the scene has the entries
  ///   scene    from whose coordinates the file's world follows
  /// Errors: those of read_own_luminaires.
  LuminaireEditor(std::filesystem::path file, std::vector<loading::PlacedLuminaires> placed,
                  const Scene& scene);

  const std::filesystem::path& file() const { return file_; }
  const loading::LuminaireList& list() const { return list_; }
  const std::vector<loading::PlacedLuminaires>& placed() const { return placed_; }

  /// An earlier or later list; the positions of its lamps are known when it is loaded.
  void restore(loading::LuminaireList list);
  /// The result of loading a list.
  void loaded(const std::string& text, std::vector<loading::PlacedLuminaires> placed);

  bool unsaved() const { return list_ != saved_; }
  /// Errors: those of write_luminaires.
  void save();

  std::optional<std::size_t> selected() const { return selected_; }
  void select(std::optional<std::size_t> entry) { selected_ = entry; }

  /// Photometric files in the list's folder, by name, and those that entries have.
  std::vector<std::string> photometric_files() const;
  /// The photometric file of lamps to be placed: that of the newest entry, else the first there is;
  /// "" = none.
  std::string next_file() const;
  void set_next_file(const std::string& name) { next_file_ = name; }

  /// The entry one of whose openings a ray meets within `farthest` metres.
  ///   direction   unit
  std::optional<std::size_t> along(const glm::dvec3& eye, const glm::dvec3& direction,
                                   double farthest) const;

  // Edits. All but `place` are of the selected entry, and do nothing where none is.

  /// Adds a lamp on a surface, shining away from it, and selects it.
  ///   position, normal   in the scene, the normal unit
  /// Errors: UsageError where there is no photometric file to place.
  void place(const glm::dvec3& position, const glm::dvec3& normal);
  /// Beside the first, in line with it; the copy is selected.
  void duplicate();
  void remove();
  /// Adds degrees to the rotation.
  void rotate(double degrees);
  /// Moves it in the plane of its openings as a pointer moves that points along these unit
  /// directions from the eye. Returns whether it could.
  bool drag(const glm::dvec3& eye, const glm::dvec3& from, const glm::dvec3& to);
  void set_position(const glm::dvec3& world);
  void set_lumens(double lumens);
  void set_array(int columns, int rows, const glm::dvec2& spacing);

  /// The position of the selected entry, in the file's world.
  glm::dvec3 position() const;

 private:
  nlohmann::ordered_json& entry() { return list_.entries[*selected_]; }
  /// The selected lamps' place; null while it is not known.
  loading::PlacedLuminaires* at();
  std::string free_name(const std::string& name) const;
  void write_position(const glm::dvec3& in_scene);
  glm::dvec3 in_world(const glm::dvec3& in_scene) const;

  std::filesystem::path file_;
  glm::dvec3 origin_;  ///< of the scene, as Scene has it
  glm::dmat3 turn_;    ///< likewise
  loading::LuminaireList list_, saved_;
  std::vector<loading::PlacedLuminaires> placed_;
  std::optional<std::size_t> selected_;
  std::string next_file_;
};

}  // namespace photile::view
