#include "view/luminaire_session.hpp"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <limits>
#include <utility>

#include "photile/errors.hpp"
#include "view/picture_area.hpp"

namespace photile::view {

namespace {

constexpr double step_degrees = 15;
constexpr double on_surface = 0.02;  ///< metres, of an opening behind what a ray meets first

void draw_opening(const loading::PlacedLuminaires& lamps, const glm::dvec3& middle,
                  const Camera& camera, ImU32 colour, float width) {
  const PictureArea area = PictureArea::now();
  std::array<ImVec2, 4> corners;
  constexpr std::array<glm::dvec2, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 along = 0.5 * signs[i] * lamps.opening;
    const auto corner =
        area.shown(camera, middle + along.x * lamps.axes[0] + along.y * lamps.axes[1]);
    if (!corner) return;
    corners[i] = *corner;
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
  const glm::dvec3 direction = PictureArea::now().direction(camera, io.MousePos);
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
                          const std::optional<PhotonInspector::Surface>& surface) {
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

void LuminaireSession::released() {
  if (std::exchange(load_, false)) loader_.load(editor_.list().text());
}

std::shared_ptr<const Scene> LuminaireSession::take_scene(std::string& message) {
  if (const std::exception_ptr error = loader_.take_error()) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& told) {
      message = told.what();
    }
  }
  const auto loaded = loader_.take();
  if (!loaded) return nullptr;
  editor_.loaded(loaded->luminaires, loaded->scene->luminaires);
  return {loaded->scene, &loaded->scene->scene};
}

bool LuminaireSession::save(std::string& message) {
  const std::string name = editor_.file().filename().string();
  try {
    editor_.save();
    message = fmt::format("{} is saved", name);
    return true;
  } catch (const Error& error) {
    message = error.what();
    return false;
  }
}

bool LuminaireSession::click(const Camera& camera, const glm::dvec3& direction,
                             const std::optional<PhotonInspector::Surface>& surface,
                             std::string& message) {
  try {
    return tool_.click(camera, direction, surface);
  } catch (const Error& error) {
    message = error.what();
    return true;
  }
}

bool LuminaireSession::may_close() {
  closing_ = editor_.unsaved() && !discarded_;
  return !closing_;
}

bool LuminaireSession::close_as(Closing closing, std::string& message) {
  if (closing == Closing::undecided) return false;
  closing_ = false;
  discarded_ = closing == Closing::discard;
  return discarded_ || (closing == Closing::save && save(message));
}

void LuminaireSession::tell_unsaved(Progress& notes) const {
  if (!editor_.unsaved() || discarded_) return;
  notes.note(fmt::format("{}: changes of luminaires are not saved", editor_.file().string()));
}

}  // namespace photile::view
