// Luminaires that are edited in the window: their file, the hands on them, and the scene with them.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "photile/progress.hpp"
#include "view/luminaire_tool.hpp"
#include "view/scene_loader.hpp"

namespace photile::view {

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
  ///   message   is told why there is none
  std::shared_ptr<const Scene> take_scene(std::string& message);

  /// As LuminaireTool, but that `message` is told of errors.
  bool click(const Camera& camera, const glm::dvec3& direction,
             const std::optional<PhotonInspector::Place>& surface, std::string& message);

  /// Returns whether it is saved; `message` is told either way.
  bool save(std::string& message);

  /// Whether the window may be closed; else what becomes of unsaved changes is asked.
  bool may_close();
  bool closing() const { return closing_; }
  /// The answer. Returns whether the window is to be closed.
  bool close_as(Closing closing, std::string& message);
  /// At the end: that changes are lost, if they are.
  void tell_unsaved(Progress& notes) const;

 private:
  LuminaireEditor editor_;
  LuminaireTool tool_;
  SceneLoader loader_;
  bool load_ = false, closing_ = false, discarded_ = false;
};

}  // namespace photile::view
