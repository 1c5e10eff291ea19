#include "view/navigation.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

namespace photile::view {

namespace {

const glm::dvec3 up_axis(0, 1, 0);
constexpr double steepest = glm::radians(89.0);

}  // namespace

void Viewpoint::walk(double forward, double right, double up) {
  glm::dvec3 heading = camera_.forward - glm::dot(camera_.forward, up_axis) * up_axis;
  // When looking straight down or up, the top of the picture is ahead.
  if (glm::length(heading) < 1e-6) heading = camera_.up - glm::dot(camera_.up, up_axis) * up_axis;
  heading = glm::normalize(heading);
  camera_.position += forward * heading + right * glm::cross(heading, up_axis) + up * up_axis;
}

void Viewpoint::turn(double right, double upwards) {
  const double pitch = std::asin(std::clamp(glm::dot(camera_.forward, up_axis), -1.0, 1.0));
  // A first camera that is steeper than that may only turn back.
  const double lowest = std::min(-steepest, pitch), highest = std::max(steepest, pitch);
  const double tilt = std::clamp(pitch + upwards, lowest, highest) - pitch;
  for (glm::dvec3* axis : {&camera_.forward, &camera_.up}) {
    *axis = glm::rotate(glm::rotate(*axis, tilt, camera_.right), -right, up_axis);
  }
  // The basis has to stay orthonormal after thousands of turns.
  camera_.forward = glm::normalize(camera_.forward);
  camera_.right = glm::normalize(glm::cross(camera_.forward, camera_.up));
  camera_.up = glm::cross(camera_.right, camera_.forward);
}

void Viewpoint::orbit(double right, double upwards, double distance) {
  const glm::dvec3 pivot = camera_.position + distance * camera_.forward;
  turn(right, upwards);
  camera_.position = pivot - distance * camera_.forward;
}

namespace {

/// Radians that a pixel of a drag turns.
constexpr double turn_per_pixel = 0.004;
/// The pixels that the pointer may move during a click; more is a drag.
constexpr float click_tremble = 4;
/// The part of a second's walk that a notch of the wheel is.
constexpr double wheel_share = 0.25;

double key(int plus, int minus) {
  return static_cast<double>(ImGui::IsKeyDown(plus)) - static_cast<double>(ImGui::IsKeyDown(minus));
}

}  // namespace

bool Navigation::update(Viewpoint& viewpoint, bool left_taken) {
  const ImGuiIO& io = ImGui::GetIO();
  bool moved = false;
  if (!io.WantCaptureKeyboard && !io.KeyCtrl) {
    const double forward = key(GLFW_KEY_W, GLFW_KEY_S), right = key(GLFW_KEY_D, GLFW_KEY_A),
                 up = key(GLFW_KEY_E, GLFW_KEY_Q);
    // A frame that took long must not become a jump.
    const double metres =
        speed_ * std::min(static_cast<double>(io.DeltaTime), 0.1) * (io.KeyShift ? 3 : 1);
    if (forward != 0 || right != 0 || up != 0) {
      viewpoint.walk(forward * metres, right * metres, up * metres);
      moved = true;
    }
  }
  if (!io.WantCaptureMouse) {
    const double across = turn_per_pixel * static_cast<double>(io.MouseDelta.x);
    const double upwards = -turn_per_pixel * static_cast<double>(io.MouseDelta.y);
    const bool dragged = across != 0 || upwards != 0;
    if (dragged && !left_taken && ImGui::IsMouseDragging(ImGuiMouseButton_Left, click_tremble)) {
      viewpoint.turn(-across, -upwards);  // what was grabbed follows the pointer
      moved = true;
    } else if (dragged && ImGui::IsMouseDragging(ImGuiMouseButton_Right, click_tremble)) {
      viewpoint.orbit(-across, -upwards, orbit_distance_);
      moved = true;
    }
    if (io.MouseWheel != 0) {
      viewpoint.walk(wheel_share * speed_ * static_cast<double>(io.MouseWheel), 0, 0);
      moved = true;
    }
  }
  return moved;
}

bool Navigation::clicked() const {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return false;
  return io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] <= click_tremble * click_tremble;
}

}  // namespace photile::view
