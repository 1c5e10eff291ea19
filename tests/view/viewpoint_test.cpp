// Walking, turning and orbiting.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "view/navigation.hpp"

namespace photile::test {

using view::Viewpoint;

namespace {

constexpr double quarter_turn = glm::half_pi<double>();

Camera looking_along_minus_z() {
  return Camera::look_at({0, 1.6, 0}, {0, 1.6, -1}, {0, 1, 0}, glm::radians(50.0));
}

void check_near(const glm::dvec3& is, const glm::dvec3& expected) {
  INFO(is.x << " " << is.y << " " << is.z);
  CHECK(glm::distance(is, expected) < 1e-9);
}

}  // namespace

TEST_CASE("walking goes along the level heading, to the right and up") {
  Viewpoint viewpoint(looking_along_minus_z());
  viewpoint.turn(0, 0.5);  // looks up, still walks on the floor
  viewpoint.walk(2, 1, 0.25);
  check_near(viewpoint.camera().position, {1, 1.85, -2});
}

TEST_CASE("a quarter turn to the right looks to the right, and walks there") {
  Viewpoint viewpoint(looking_along_minus_z());
  viewpoint.turn(quarter_turn, 0);
  check_near(viewpoint.camera().forward, {1, 0, 0});
  check_near(viewpoint.camera().right, {0, 0, 1});
  viewpoint.walk(3, 0, 0);
  check_near(viewpoint.camera().position, {3, 1.6, 0});
}

TEST_CASE("the head stops short of straight up and down") {
  Viewpoint viewpoint(looking_along_minus_z());
  viewpoint.turn(0, 10);
  CHECK(viewpoint.camera().forward.y == Approx(std::sin(glm::radians(89.0))));
  viewpoint.turn(0, -20);
  CHECK(viewpoint.camera().forward.y == Approx(-std::sin(glm::radians(89.0))));
}

TEST_CASE("orbiting keeps what lies ahead in the middle, at its distance") {
  Viewpoint viewpoint(looking_along_minus_z());
  viewpoint.orbit(quarter_turn, 0, 4);
  const Camera& camera = viewpoint.camera();
  check_near(camera.position + 4.0 * camera.forward, {0, 1.6, -4});
  check_near(camera.position, {-4, 1.6, -4});
}

TEST_CASE("a hundred thousand turns leave the camera's axes unit and perpendicular") {
  Viewpoint viewpoint(looking_along_minus_z());
  for (int i = 0; i < 100'000; ++i) viewpoint.turn(0.01, i % 2 == 0 ? 0.02 : -0.02);
  const Camera& camera = viewpoint.camera();
  CHECK(glm::length(camera.forward) == Approx(1).margin(1e-12));
  CHECK(glm::length(camera.right) == Approx(1).margin(1e-12));
  CHECK(glm::dot(camera.forward, camera.up) == Approx(0).margin(1e-12));
  CHECK(glm::dot(camera.right, camera.up) == Approx(0).margin(1e-12));
  CHECK(camera.right.y == Approx(0).margin(1e-6));  // no roll
}

TEST_CASE("a camera that looks straight down walks towards the top of its picture") {
  Viewpoint viewpoint(Camera::look_at({0, 5, 0}, {0, 0, 0}, {1, 0, 0}, glm::radians(50.0)));
  viewpoint.walk(1, 0, 0);
  check_near(viewpoint.camera().position, {1, 5, 0});
}

}  // namespace photile::test
