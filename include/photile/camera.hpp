// A pinhole camera.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "photile/defaults.hpp"

namespace photile {

/// The directions through a film of some size: what all of its pixels share, computed once.
class FilmDirections {
 public:
  FilmDirections(const glm::dvec3& forward, const glm::dvec3& right, const glm::dvec3& up,
                 double half_height, int width, int height);

  /// Unit direction through film position (x, y) in pixels, (0,0) the upper left corner of the
  /// picture.
  glm::dvec3 operator()(double x, double y) const {
    return glm::normalize(forward_ + (2.0 * x / width_ - 1.0) * half_right_ +
                          (1.0 - 2.0 * y / height_) * half_up_);
  }

 private:
  glm::dvec3 forward_, half_right_, half_up_;
  double width_, height_;
};

/// Right-handed: `right` = `forward` x `up`. All three are unit and orthogonal. Metres, radians.
struct Camera {
  std::string name;
  glm::dvec3 position{0.0};
  glm::dvec3 forward{0.0, 0.0, -1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};
  double vertical_field_of_view = glm::radians(defaults::vertical_field_of_view);
  double aspect_ratio = 0;  ///< width / height as the file states it; 0 = follow the picture

  /// A camera at `position` that looks at `target` with `up_hint` upwards in the picture.
  static Camera look_at(const glm::dvec3& position, const glm::dvec3& target,
                        const glm::dvec3& up_hint, double vertical_field_of_view);

  /// For a film of width x height pixels. The vertical field of view spans the height.
  FilmDirections directions(int width, int height) const;

  /// One of them.
  glm::dvec3 direction(double x, double y, int width, int height) const {
    return directions(width, height)(x, y);
  }
};

}  // namespace photile
