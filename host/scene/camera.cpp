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

FilmDirections::FilmDirections(const glm::dvec3& forward, const glm::dvec3& right,
                               const glm::dvec3& up, double half_height, int width, int height)
    : forward_(forward),
      half_right_(half_height * width / height * right),
      half_up_(half_height * up),
      width_(width),
      height_(height) {}

FilmDirections Camera::directions(int width, int height) const {
  return {forward, right, up, std::tan(0.5 * vertical_field_of_view), width, height};
}

}  // namespace photile
