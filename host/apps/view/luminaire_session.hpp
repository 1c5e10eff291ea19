// Luminaires that are edited in the window: their file, the input on them (mouse, keys, outlines),
// and the scene that is loaded again with them.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "loading/load_scene.hpp"
#include "photile/camera.hpp"
#include "photile/load_scene.hpp"
#include "photile/progress.hpp"
#include "view/luminaire_editor.hpp"
#include "view/photon_map.hpp"
#include "view/scene_loader.hpp"

namespace photile::view {

class LuminaireTool {
 public:
  /// The editor is kept as a reference.
  explicit LuminaireTool(LuminaireEditor& editor) : editor_(editor) {}

  LuminaireEditor& editor() { return editor_; }

  /// Whether the next click places lamps.
  bool& placing() { return placing_; }

  /// Delete, Ctrl+D, R, P and Escape.
  void take_keys();

  /// Moves selected lamps that the left button holds. Before the navigation takes the mouse:
  /// returns whether it is not to.
  ///   camera   of the picture that fills the window
  bool drag(const Camera& camera);
  bool dragging() const { return held_.has_value(); }

  /// A click on what a picture shows: places, or selects. Returns whether it was for lamps.
  ///   direction   of the ray through the place, unit
  ///   surface     that it meets, or none
  /// Errors: those of LuminaireEditor::place.
  bool click(const Camera& camera, const glm::dvec3& direction,
             const std::optional<PhotonInspector::Surface>& surface);

  /// Outlines of all openings, the selected ones in colour.
  void draw(const Camera& camera) const;

 private:
  LuminaireEditor& editor_;
  bool placing_ = false;
  std::optional<glm::dvec3> held_;  ///< direction to where the pointer holds them
};

/// What becomes of unsaved changes.
enum class Closing { undecided, save, discard, stay };

class LuminaireSession {
 public:
  ///   file     of the list
  ///   placed   as the scene has its entries
  ///   load     with which the scene was loaded
  /// Errors: those of LuminaireEditor.
  LuminaireSession(const std::filesystem::path& file, std::vector<loading::PlacedLuminaires> placed,
                   const Scene& scene, const SceneLoadOptions& load)
      : editor_(file, std::move(placed), scene), tool_(editor_), loader_(scene.source, load) {}

  LuminaireEditor& editor() { return editor_; }
  const LuminaireEditor& editor() const { return editor_; }
  LuminaireTool& tool() { return tool_; }
  bool loading() const { return loader_.busy(); }

  /// The scene is to have the list as it is now, once nothing is held any longer.
  void load_again() { load_ = true; }
  void released();

  /// The scene with the newest list, once; null where there is none.
  ///   message   becomes the reason why there is none
  std::shared_ptr<const Scene> take_scene(std::string& message);

  /// Takes a click as LuminaireTool does, but `message` gets the errors.
  bool click(const Camera& camera, const glm::dvec3& direction,
             const std::optional<PhotonInspector::Surface>& surface, std::string& message);

  /// Returns whether it is saved; `message` is set in either case.
  bool save(std::string& message);

  /// Whether the window may be closed; else what becomes of unsaved changes is asked.
  bool may_close();
  bool closing() const { return closing_; }
  /// The answer. Returns whether the window is to be closed.
  bool close_as(Closing closing, std::string& message);
  /// At the end: a message that changes are lost, if they are.
  void tell_unsaved(Progress& notes) const;

 private:
  LuminaireEditor editor_;
  LuminaireTool tool_;
  SceneLoader loader_;
  bool load_ = false, closing_ = false, discarded_ = false;
};

}  // namespace photile::view
