// Hands on luminaires: mouse and keys, and outlines over the picture.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "photile/camera.hpp"
#include "view/luminaire_editor.hpp"
#include "view/photon_map_overlay.hpp"

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
             const std::optional<PhotonInspector::Place>& surface);

  /// Outlines of all openings, the selected ones in colour.
  void draw(const Camera& camera) const;

 private:
  LuminaireEditor& editor_;
  bool placing_ = false;
  std::optional<glm::dvec3> held_;  ///< direction to where the pointer holds them
};

}  // namespace photile::view
