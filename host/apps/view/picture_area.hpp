// Where the picture lies in the window: beside the panel.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>
#include <optional>

#include "photile/camera.hpp"

namespace photile::view {

/// The part of the window that no panel is docked to, in the units of the mouse.
struct PictureArea {
  ImVec2 corner, size;

  /// The area in the current frame of Dear ImGui, which has begun.
  static PictureArea now();

  /// A point of the window, as shares of the picture's width and height.
  glm::dvec2 shares(const ImVec2& point) const;
  /// Unit direction through a point of the window.
  glm::dvec3 direction(const Camera& camera, const ImVec2& point) const;
  /// Where in the window the camera shows a position; none behind the camera.
  std::optional<ImVec2> shown(const Camera& camera, const glm::dvec3& position) const;
};

}  // namespace photile::view
