// Luminaires that pages place and move: their file, and the scene that is loaded again with them.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "loading/luminaires.hpp"
#include "photile/load_scene.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "view/history.hpp"
#include "view/luminaire_editor.hpp"
#include "view/scene_loader.hpp"

namespace photile::serve {

/// All pages edit one list, in which one entry is selected.
class LiveLuminaires {
 public:
  ///   file     of the list; it may not exist yet
  ///   placed   as the scene has its entries
  ///   load     with which the scene was loaded
  /// Errors: those of view::LuminaireEditor.
  LiveLuminaires(const std::filesystem::path& file, std::vector<loading::PlacedLuminaires> placed,
                 const Scene& scene, const SceneLoadOptions& load);

  /// An edit as page/luminaires.js posts it. Returns the answer. After an edit that holds nothing
  /// any longer the scene is loaded again.
  /// Errors: InputError for a damaged edit; those of view::LuminaireEditor.
  nlohmann::json edit(const nlohmann::json& body);
  /// What pages show.
  nlohmann::json state() const;

  /// The scene with the newest list, once; null where there is none.
  /// Errors: why the list cannot be loaded.
  std::shared_ptr<const Scene> take_scene();

  /// The entries as a scene is loaded with them.
  std::string text() const { return editor_.list().text(); }
  /// At the end: a message that changes are lost, if they are.
  void tell_unsaved(Progress& notes) const;

 private:
  view::LuminaireEditor editor_;
  view::History<loading::LuminaireList> history_;
  bool changed_ = false;  ///< since the scene was loaded
  view::SceneLoader loader_;
};

}  // namespace photile::serve
