// A camera: a pinhole, or one of the projections of light measurement.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "photile/defaults.hpp"

namespace photile {

/// How directions become positions on the film. Radiance's view types are named.
enum class Projection {
  perspective,      ///< a pinhole: -vtv
  fisheye,          ///< hemispherical: the sine of the angle to the axis is the radius: -vth
  angular,          ///< the angle to the axis is the radius: -vta
  equirectangular,  ///< the whole sphere: longitude across, latitude up
  orthographic      ///< parallel rays: -vtl
};

/// "perspective", "fisheye", "angular", "equirectangular", "orthographic".
std::string_view name_of(Projection projection);
inline constexpr std::array all_projections = {Projection::perspective, Projection::fisheye,
                                               Projection::angular, Projection::equirectangular,
                                               Projection::orthographic};

struct Camera;

/// The rays through a film of some size: what all of its pixels share, computed once.
class FilmDirections {
 public:
  /// Errors: UsageError for a camera whose position, axes or field of view are out of range or not
  /// finite.
  FilmDirections(const Camera& camera, int width, int height);

  /// Unit direction through film position (x, y) in pixels, (0,0) the upper left corner of the
  /// picture. Zero outside the circle of a fisheye, where nothing is visible.
  glm::dvec3 operator()(double x, double y) const {
    if (projection_ != Projection::perspective) return curved(x, y);
    return glm::normalize(forward_ + (2.0 * x / width_ - 1.0) * half_right_ +
                          (1.0 - 2.0 * y / height_) * half_up_);
  }

  /// From the camera's position to where the ray starts, metres: 0 except for parallel rays.
  glm::dvec3 offset(double x, double y) const {
    if (projection_ != Projection::orthographic) return glm::dvec3(0.0);
    return (2.0 * x / width_ - 1.0) * half_right_ + (1.0 - 2.0 * y / height_) * half_up_;
  }

 private:
  glm::dvec3 curved(double x, double y) const;

  glm::dvec3 forward_, half_right_, half_up_;  ///< both halves of fisheyes are unit
  double width_, height_;
  Projection projection_;
  double half_angle_;  ///< radians, of a fisheye
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
  Projection projection = Projection::perspective;
  /// Height of a picture of parallel rays, metres.
  double orthographic_height = defaults::orthographic_height;

  /// A camera at `position` that looks at `target` with `up_hint` upwards in the picture.
  static Camera look_at(const glm::dvec3& position, const glm::dvec3& target,
                        const glm::dvec3& up_hint, double vertical_field_of_view);

  /// For a film of width x height pixels. The vertical field of view spans the height; of a fisheye
  /// it is the angle across the circle that touches the upper and lower border.
  FilmDirections directions(int width, int height) const;

  /// The direction at one film position.
  glm::dvec3 direction(double x, double y, int width, int height) const {
    return directions(width, height)(x, y);
  }
};

}  // namespace photile
