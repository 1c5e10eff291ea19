// Where the projections of a camera look.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/camera.hpp"
#include "photile/errors.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

Camera camera_of(Projection projection, double degrees = 180) {
  Camera camera;  // along -z, y up
  camera.projection = projection;
  camera.vertical_field_of_view = glm::radians(degrees);
  return camera;
}

/// Right and up from the middle, 1 at the right and upper border of a square picture.
glm::dvec3 seen(const Camera& camera, double right, double up) {
  return camera.direction(50 + 50 * right, 50 - 50 * up, 100, 100);
}

double angle_to_axis(const glm::dvec3& direction) { return std::acos(-direction.z); }

}  // namespace

TEST_CASE("a camera whose rays would be no numbers is refused") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const Camera& camera) {
    CHECK_THROWS_AS(camera.directions(4, 4), UsageError);
  };
  for (const double far : {1e20, none}) {
    Camera camera = camera_of(Projection::perspective, 60);
    camera.position.y = far;
    refused(camera);
  }
  for (const double degrees : {0.0, -60.0, 361.0, none}) {
    refused(camera_of(Projection::perspective, degrees));
  }
  Camera parallel = camera_of(Projection::orthographic);
  for (const double height : {0.0, 1e19, none}) {
    parallel.orthographic_height = height;
    refused(parallel);
  }
  Camera tilted = camera_of(Projection::perspective, 60);
  tilted.up = {0, none, 0};
  refused(tilted);
}

TEST_CASE("in the angular projection the radius is the angle") {
  for (const double degrees : {90.0, 180.0, 300.0}) {
    const Camera camera = camera_of(Projection::angular, degrees);
    for (const double radius : {0.0, 0.3, 0.9}) {
      const glm::dvec3 aside = seen(camera, radius, 0), above = seen(camera, 0, radius);
      CHECK(angle_to_axis(aside) == Approx(glm::radians(0.5 * degrees) * radius).margin(1e-7));
      CHECK(angle_to_axis(above) == Approx(angle_to_axis(aside)).margin(1e-7));
      CHECK(aside.x >= 0);
      CHECK(above.y >= 0);
    }
  }
  CHECK(seen(camera_of(Projection::angular), 0.8, 0.8) == glm::dvec3(0));  // beyond the circle
}

TEST_CASE("in the hemispherical projection the radius is the sine") {
  const Camera camera = camera_of(Projection::fisheye);
  CHECK(angle_to_axis(seen(camera, 0.5, 0)) == Approx(glm::pi<double>() / 6));
  CHECK(angle_to_axis(seen(camera, 0, -0.5)) == Approx(glm::pi<double>() / 6));
  CHECK(glm::length(seen(camera, 0.6, 0.6)) == Approx(1));
  CHECK(seen(camera, 0.8, 0.8) == glm::dvec3(0));
  const Camera half = camera_of(Projection::fisheye, 60);
  CHECK(angle_to_axis(seen(half, 1, 0)) == Approx(glm::pi<double>() / 6));
}

TEST_CASE("an equirectangular picture is the whole sphere") {
  const Camera camera = camera_of(Projection::equirectangular);
  const auto close = [](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::distance(a, b) < 1e-12;
  };
  CHECK(close(seen(camera, 0, 0), {0, 0, -1}));
  CHECK(close(seen(camera, 0.5, 0), {1, 0, 0}));
  CHECK(close(seen(camera, -0.5, 0), {-1, 0, 0}));
  CHECK(close(seen(camera, 1, 0), {0, 0, 1}));
  CHECK(close(seen(camera, 0.3, 1), {0, 1, 0}));
  CHECK(close(seen(camera, 0.3, -1), {0, -1, 0}));
}

TEST_CASE("orthographic rays are parallel and start beside each other") {
  Camera camera = camera_of(Projection::orthographic);
  camera.orthographic_height = 6;
  const FilmDirections film = camera.directions(200, 100);
  CHECK(film(3, 7) == glm::dvec3(0, 0, -1));
  CHECK(film.offset(0, 0) == glm::dvec3(-6, 3, 0));
  CHECK(film.offset(200, 100) == glm::dvec3(6, -3, 0));
  CHECK(camera_of(Projection::perspective, 90).directions(9, 9).offset(0, 0) == glm::dvec3(0));
}

TEST_CASE("a pinhole is as it was") {
  const glm::dvec3 corner = seen(camera_of(Projection::perspective, 90), 1, 1);
  CHECK(glm::distance(corner, glm::normalize(glm::dvec3(1, 1, -1))) < 1e-12);
}

}  // namespace photile::test
