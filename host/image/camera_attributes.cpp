#include "photile/camera_attributes.hpp"

#include <cmath>
#include <glm/glm.hpp>

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

}  // namespace

void set_camera_attributes(PictureHeader& image, const Camera& camera, int width, int height) {
  const auto coordinate_along = [&](const glm::dvec3& axis) {
    return glm::dvec4(axis, -glm::dot(axis, camera.position));
  };
  const glm::dvec4 x = coordinate_along(camera.right);
  const glm::dvec4 y = coordinate_along(camera.up);
  const glm::dvec4 depth = coordinate_along(camera.forward);
  const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
  image.matrices["worldToCamera"] = from_columns(x, y, depth, one);

  const double tan_y = std::tan(0.5 * camera.vertical_field_of_view);
  const double tan_x = tan_y * width / height;
  image.matrices["worldToNDC"] =
      from_columns(0.5 / tan_x * x + 0.5 * depth, -0.5 / tan_y * y + 0.5 * depth, one, depth);
}

}  // namespace photile
