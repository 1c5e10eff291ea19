#include <cmath>

#include "photile/layered_picture.hpp"
#include "picture_support.hpp"

namespace photile::test {
namespace {

/// Row vector times matrix, in double precision.
glm::dvec4 transform(const glm::dvec3& point, const std::array<float, 16>& matrix) {
  const double p[4] = {point.x, point.y, point.z, 1.0};
  glm::dvec4 result(0.0);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      result[column] += p[row] * matrix[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return result;
}

/// A camera turned and moved, its axes computed here.
Camera oblique_camera() {
  Camera camera;
  camera.position = {1.0, 2.0, 3.0};
  camera.forward = glm::normalize(glm::dvec3(0.3, -0.4, -0.8));
  camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0.0, 1.0, 0.0)));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.vertical_field_of_view = glm::radians(50.0);
  return camera;
}

}  // namespace

TEST_CASE("worldToCamera puts right, up and depth on x, y and z, left-handed") {
  const Camera camera = oblique_camera();
  Image image;
  set_camera_attributes(image, camera, 640, 480);
  const glm::dvec3 point =
      camera.position + 2.0 * camera.right + 3.0 * camera.up + 5.0 * camera.forward;
  const glm::dvec4 seen = transform(point, image.matrices.at("worldToCamera"));
  CHECK(seen.x == Approx(2.0).epsilon(1e-5));
  CHECK(seen.y == Approx(3.0).epsilon(1e-5));
  CHECK(seen.z == Approx(5.0).epsilon(1e-5));
  CHECK(seen.w == Approx(1.0));
}

TEST_CASE("worldToNDC puts the picture's corners on the unit square, (0,0) upper left") {
  const Camera camera = oblique_camera();
  const double tan_y = std::tan(glm::radians(25.0)), tan_x = tan_y * 640.0 / 480.0;
  Image image;
  set_camera_attributes(image, camera, 640, 480);
  struct Corner {
    double right, up, x, y;
  };
  for (const Corner& corner : {Corner{-1, 1, 0, 0}, Corner{1, 1, 1, 0}, Corner{-1, -1, 0, 1},
                               Corner{1, -1, 1, 1}, Corner{0.5, 0, 0.75, 0.5}}) {
    const glm::dvec3 point =
        camera.position + 7.0 * (camera.forward + corner.right * tan_x * camera.right +
                                 corner.up * tan_y * camera.up);
    const glm::dvec4 ndc = transform(point, image.matrices.at("worldToNDC"));
    CHECK(ndc.x / ndc.w == Approx(corner.x).margin(1e-5));
    CHECK(ndc.y / ndc.w == Approx(corner.y).margin(1e-5));
    CHECK(ndc.z / ndc.w == Approx(1.0 / 7.0).epsilon(1e-4));
  }
}

}  // namespace photile::test
