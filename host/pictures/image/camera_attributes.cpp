#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "photile/layered_picture.hpp"

namespace photile {
namespace {

/// A matrix for row vectors whose columns are given: the way EXR stores it, row after row.
std::array<float, 16> from_columns(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& z,
                                   const glm::dvec4& w) {
  std::array<float, 16> matrix{};
  for (int row = 0; row < 4; ++row) {
    const std::size_t first = 4 * static_cast<std::size_t>(row);
    matrix[first + 0] = static_cast<float>(x[row]);
    matrix[first + 1] = static_cast<float>(y[row]);
    matrix[first + 2] = static_cast<float>(z[row]);
    matrix[first + 3] = static_cast<float>(w[row]);
  }
  return matrix;
}

/// A view type of Radiance and how wide it is: degrees, or metres.
struct RadianceView {
  const char* type;
  double across, high;
};

std::optional<RadianceView> view_of(const Camera& camera, double aspect) {
  const double angle = camera.vertical_field_of_view, high = glm::degrees(angle);
  switch (camera.projection) {
    case Projection::perspective:
      return RadianceView{"-vtv", glm::degrees(2.0 * std::atan(aspect * std::tan(0.5 * angle))),
                          high};
    case Projection::fisheye: {
      const double sine = aspect * std::sin(0.5 * angle);
      if (sine > 1.0 + 1e-9) return std::nullopt;
      return RadianceView{"-vth", glm::degrees(2.0 * std::asin(std::min(1.0, sine))), high};
    }
    case Projection::angular:
      return RadianceView{"-vta", aspect * high, high};
    case Projection::orthographic:
      return RadianceView{"-vtl", aspect * camera.orthographic_height, camera.orthographic_height};
    case Projection::equirectangular:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::string radiance_view(const Camera& camera, int width, int height) {
  const auto view = view_of(camera, static_cast<double>(width) / height);
  if (!view) return "";
  const glm::dvec3 &p = camera.position, &d = camera.forward, &u = camera.up;
  return fmt::format(
      "{} -vp {:.9g} {:.9g} {:.9g} -vd {:.9g} {:.9g} {:.9g} -vu {:.9g} {:.9g} {:.9g} "
      "-vh {:.9g} -vv {:.9g}",
      view->type, p.x, p.y, p.z, d.x, d.y, d.z, u.x, u.y, u.z, view->across, view->high);
}

void set_camera_attributes(PictureHeader& image, const Camera& camera, int width, int height) {
  if (const std::string view = radiance_view(camera, width, height); !view.empty()) {
    image.attributes["photile.view"] = view;
  }
  const auto coordinate_along = [&](const glm::dvec3& axis) {
    return glm::dvec4(axis, -glm::dot(axis, camera.position));
  };
  const glm::dvec4 x = coordinate_along(camera.right);
  const glm::dvec4 y = coordinate_along(camera.up);
  const glm::dvec4 depth = coordinate_along(camera.forward);
  const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
  image.matrices["worldToCamera"] = from_columns(x, y, depth, one);

  if (camera.projection != Projection::perspective) return;
  const double tan_y = std::tan(0.5 * camera.vertical_field_of_view);
  const double tan_x = tan_y * width / height;
  image.matrices["worldToNDC"] =
      from_columns(0.5 / tan_x * x + 0.5 * depth, -0.5 / tan_y * y + 0.5 * depth, one, depth);
}

}  // namespace photile
