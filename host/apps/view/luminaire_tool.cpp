#include "view/luminaire_tool.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <array>
#include <limits>

namespace photile::view {
namespace {

constexpr double step_degrees = 15;
constexpr double on_surface = 0.02;  ///< metres: an opening may lie so far behind what is met first

/// Through the pointer, of a picture that fills the window.
glm::dvec3 direction_at_pointer(const Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  return camera.direction(static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y),
                          static_cast<int>(io.DisplaySize.x), static_cast<int>(io.DisplaySize.y));
}

void draw_opening(const loading::PlacedLuminaires& lamps, const glm::dvec3& middle,
                  const Camera& camera, ImU32 colour, float width) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  std::array<ImVec2, 4> corners;
  constexpr std::array<glm::dvec2, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 along = 0.5 * signs[i] * lamps.opening;
    const auto place = project(camera, middle + along.x * lamps.axes[0] + along.y * lamps.axes[1],
                               static_cast<int>(size.x), static_cast<int>(size.y));
    if (!place) return;
    corners[i] = ImVec2(static_cast<float>(place->x), static_cast<float>(place->y));
  }
  ImGui::GetBackgroundDrawList()->AddPolyline(corners.data(), static_cast<int>(corners.size()),
                                              colour, ImDrawFlags_Closed, width);
}

}  // namespace

void LuminaireTool::take_keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl) {
    if (ImGui::IsKeyPressed(GLFW_KEY_D, false)) editor_.duplicate();
    return;
  }
  if (ImGui::IsKeyPressed(GLFW_KEY_DELETE, false)) editor_.remove();
  if (ImGui::IsKeyPressed(GLFW_KEY_R, true)) {
    editor_.rotate(io.KeyShift ? -step_degrees : step_degrees);
  }
  if (ImGui::IsKeyPressed(GLFW_KEY_P, false)) placing_ = !placing_;
  if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) {
    placing_ = false;
    editor_.select(std::nullopt);
  }
}

bool LuminaireTool::drag(const Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    held_.reset();
    return false;
  }
  const glm::dvec3 direction = direction_at_pointer(camera);
  if (!held_) {
    if (io.WantCaptureMouse || placing_ || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
      return false;
    }
    constexpr double anywhere = std::numeric_limits<double>::max();
    const auto under = editor_.along(camera.position, direction, anywhere);
    if (!under || under != editor_.selected()) return false;
    held_ = direction;
  }
  if (ImGui::IsMouseDragging(ImGuiMouseButton_Left) &&
      editor_.drag(camera.position, *held_, direction)) {
    held_ = direction;
  }
  return true;
}

bool LuminaireTool::click(const Camera& camera, const glm::dvec3& direction,
                          const std::optional<PhotonInspector::Place>& surface) {
  if (placing_) {
    if (!surface) return true;
    placing_ = false;
    editor_.place(surface->position, surface->normal);
    return true;
  }
  const double farthest = surface ? glm::distance(camera.position, surface->position) + on_surface
                                  : std::numeric_limits<double>::max();
  const auto under = editor_.along(camera.position, direction, farthest);
  if (under) editor_.select(under);
  return under.has_value();
}

void LuminaireTool::draw(const Camera& camera) const {
  const auto& placed = editor_.placed();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const bool selected = editor_.selected() == i;
    const ImU32 colour = selected ? IM_COL32(255, 150, 30, 255) : IM_COL32(255, 255, 255, 110);
    for (const glm::dvec3& middle : placed[i].middles()) {
      draw_opening(placed[i], middle, camera, colour, selected ? 2.5f : 1.0f);
    }
  }
}

}  // namespace photile::view
