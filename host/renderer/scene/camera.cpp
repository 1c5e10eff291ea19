#include "photile/camera.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/scene_queries.hpp"

namespace photile {
namespace {

/// Rays of a camera that fails here would be NaN or infinite, which Embree does not survive.
void check_camera(const Camera& camera) {
  if (!scene::within_limit(camera.position)) {
    throw UsageError(fmt::format("camera '{}': its position must lie within {:g} m of the origin",
                                 camera.name, limits::max_coordinate));
  }
  for (const glm::dvec3& axis : {camera.forward, camera.up, camera.right}) {
    if (std::abs(glm::length(axis) - 1) < 1e-3) continue;
    throw UsageError(
        fmt::format("camera '{}': forward, up and right must be vectors of length 1", camera.name));
  }
  const double angle = camera.vertical_field_of_view;
  const bool is_angle = angle > 0 && angle <= glm::two_pi<double>();
  if (camera.projection == Projection::orthographic
          ? !(camera.orthographic_height > 0 &&
              camera.orthographic_height <= limits::max_coordinate)
          : !is_angle) {
    throw UsageError(fmt::format("camera '{}': its field of view must be above 0 and at most {}",
                                 camera.name,
                                 camera.projection == Projection::orthographic
                                     ? fmt::format("{:g} m", limits::max_coordinate)
                                     : std::string("360 degrees")));
  }
}

}  // namespace

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

std::string_view name_of(Projection projection) {
  return name_in({"perspective", "fisheye", "angular", "equirectangular", "orthographic"},
                 projection);
}

FilmDirections::FilmDirections(const Camera& camera, int width, int height)
    : forward_(camera.forward),
      width_(width),
      height_(height),
      projection_(camera.projection),
      half_angle_(0.5 * camera.vertical_field_of_view) {
  check_camera(camera);
  double half_height = 1;
  if (projection_ == Projection::perspective) half_height = std::tan(half_angle_);
  if (projection_ == Projection::orthographic) half_height = 0.5 * camera.orthographic_height;
  half_right_ = half_height * width / height * camera.right;
  half_up_ = half_height * camera.up;
}

glm::dvec3 FilmDirections::curved(double x, double y) const {
  const double across = 2.0 * x / width_ - 1.0, upwards = 1.0 - 2.0 * y / height_;
  if (projection_ == Projection::orthographic) return forward_;
  if (projection_ == Projection::equirectangular) {
    const double longitude = glm::pi<double>() * across;
    const double latitude = glm::half_pi<double>() * upwards;
    return std::cos(latitude) * (std::cos(longitude) * forward_ +
                                 std::sin(longitude) * glm::normalize(half_right_)) +
           std::sin(latitude) * half_up_;
  }
  const glm::dvec3 aside = across * half_right_ + upwards * half_up_;
  const double radius = glm::length(aside);  // 1 at the circle
  if (!(radius <= 1.0)) return glm::dvec3(0.0);
  if (!(radius > 0.0)) return forward_;
  const double sine = projection_ == Projection::fisheye ? radius * std::sin(half_angle_)
                                                         : std::sin(radius * half_angle_);
  const double cosine = projection_ == Projection::fisheye ? std::sqrt(1.0 - sine * sine)
                                                           : std::cos(radius * half_angle_);
  return cosine * forward_ + sine / radius * aside;
}

FilmDirections Camera::directions(int width, int height) const { return {*this, width, height}; }

}  // namespace photile
