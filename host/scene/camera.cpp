#include "photile/camera.hpp"

#include <cmath>

namespace photile {

Camera Camera::look_at(const glm::dvec3& position, const glm::dvec3& target,
                       const glm::dvec3& up_hint, double vertical_field_of_view) {
  Camera camera;
  camera.position = position;
  camera.vertical_field_of_view = vertical_field_of_view;
  const glm::dvec3 view = target - position;
  const double distance = glm::length(view);
  if (distance > 0.0) camera.forward = view / distance;
  glm::dvec3 right = glm::cross(camera.forward, up_hint);
  if (glm::length(right) <= 1e-9 * glm::length(up_hint)) {
    // Looking along the hint: any axis that is far from the view will do.
    const glm::dvec3 other =
        std::abs(camera.forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    right = glm::cross(camera.forward, other);
  }
  camera.right = glm::normalize(right);
  camera.up = glm::cross(camera.right, camera.forward);
  return camera;
}

glm::dvec3 Camera::direction(double x, double y, int width, int height) const {
  const double half_height = std::tan(0.5 * vertical_field_of_view);
  const double half_width = half_height * width / height;
  return glm::normalize(forward + (2.0 * x / width - 1.0) * half_width * right +
                        (1.0 - 2.0 * y / height) * half_height * up);
}

}  // namespace photile
