// Where the projections of a camera look, and from where a scene without a camera is seen.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "photile/camera.hpp"
#include "photile/errors.hpp"
#include "test_scenes.hpp"
#include "trace/room.hpp"

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

TEST_CASE("a closed room without a camera is seen from within, whatever its size and shape") {
  const glm::vec3 size = GENERATE(glm::vec3(6, 3, 4), glm::vec3(0.3f, 0.15f, 0.2f),
                                  glm::vec3(1, 1, 12), glm::vec3(12, 1, 1), glm::vec3(1, 12, 1));
  SceneBuilder builder;
  builder.box(glm::vec3(0), size, builder.add(diffuse(0.5f)), true);
  const Camera camera = builder.build().cameras.at(0);
  const glm::dvec3 place = camera.position / glm::dvec3(size);
  CHECK(glm::compMin(place) > 0.05);
  CHECK(glm::compMax(place) < 0.95);
  // Towards the middle of the floor plan, which most of the room lies beyond.
  const glm::dvec3 ahead = 0.5 * glm::dvec3(size) - camera.position;
  CHECK(camera.forward.x * ahead.x + camera.forward.z * ahead.z > 0);
}

TEST_CASE("a building that is no box is seen from within its largest room, at eye height") {
  // An L of two legs, 10 m long each, with a wall between and a table in the larger room.
  const float wide = GENERATE(4.0f, 6.0f);  // the box has two open sides, or none
  const float turned = GENERATE(0.0f, 1.0f);
  constexpr float height = 2.7f, length = 10.0f;
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const auto at = [&](float x, float y, float z) {
    return turned > 0 ? glm::vec3(length - x, y, length - z) : glm::vec3(x, y, z);
  };
  const auto sheet = [&](const glm::vec3& from, const glm::vec3& u, const glm::vec3& v) {
    const glm::vec3 origin = at(from.x, from.y, from.z);
    builder.grid(origin, at(from.x + u.x, from.y + u.y, from.z + u.z) - origin,
                 at(from.x + v.x, from.y + v.y, from.z + v.z) - origin, 1, white);
  };
  const glm::vec3 up(0, height, 0), x(1, 0, 0), z(0, 0, 1);
  const float rest = length - wide;
  for (const glm::vec3& leg : {glm::vec3(0, 0, 0), glm::vec3(wide, 0, 0)}) {
    const glm::vec3 across = leg.x > 0 ? rest * x : wide * x;
    const glm::vec3 along = leg.x > 0 ? wide * z : length * z;
    sheet(leg, along, across);
    sheet(leg + up, across, along);
  }
  sheet({0, 0, 0}, length * x, up);
  sheet({0, 0, length}, up, wide * x);
  sheet({wide, 0, wide}, up, rest * x);
  sheet({0, 0, 0}, up, length * z);
  sheet({length, 0, 0}, wide * z, up);
  sheet({wide, 0, wide}, rest * z, up);
  const auto solid = [&](const glm::vec3& low, const glm::vec3& high) {
    const glm::vec3 a = at(low.x, low.y, low.z), b = at(high.x, high.y, high.z);
    builder.box(glm::min(a, b), glm::max(a, b), white, false);
  };
  solid({wide, 0, 0}, {wide + 0.1f, height, wide});
  solid({1, 0.7f, 2}, {wide - 1, 0.75f, 8});
  const Scene scene = builder.build();
  const Camera& camera = scene.cameras.at(0);
  const glm::vec3 eye =
      at(static_cast<float>(camera.position.x), 0, static_cast<float>(camera.position.z));
  INFO("at " << eye.x << ", " << camera.position.y << ", " << eye.z << ", ahead "
             << camera.forward.x << ", " << camera.forward.y << ", " << camera.forward.z);
  CHECK(eye.x > 0.2f);
  CHECK(eye.x < wide - 0.2f);
  CHECK(eye.z > 0.2f);
  CHECK(eye.z < length - 0.2f);
  CHECK(camera.position.y == Approx(1.6));
  CHECK(camera.right.y == Approx(0).margin(1e-12));
  CHECK(camera.up.y > 0.9);
  // It looks along the room, and the room around it is the larger one.
  const glm::dvec3 middle(at(0.5f * wide, 0, 0.5f * length));
  const glm::dvec3 ahead = middle - camera.position;
  CHECK(camera.forward.x * ahead.x + camera.forward.z * ahead.z > 0);
  const RayScene rays(scene);
  const auto room = trace::Room::of_camera(rays, trace::PlanAxes(), camera);
  REQUIRE(room.has_value());
  CHECK(static_cast<double>(room->positions().size()) * room->cell_area() ==
        Approx(wide * length).epsilon(0.05));
}

TEST_CASE("beside a stairwell the room is the one in which the point lies") {
  SceneBuilder builder;
  const std::uint32_t paint = builder.add(diffuse(0.5f));
  builder.box({0, 0, 0}, {8, 5.4f, 6}, paint, true);
  // The floor of the upper storey, with a hole from 3 to 5 m.
  builder.box({0, 2.6f, 0}, {3, 2.8f, 6}, paint, false);
  builder.box({5, 2.6f, 0}, {8, 2.8f, 6}, paint, false);
  const Scene scene = builder.build();
  const RayScene rays(scene);
  const double x = GENERATE(1.0, 2.2, 2.9);
  const auto room = trace::Room::around(rays, trace::PlanAxes(), {x, 1.6, 3});
  REQUIRE(room.has_value());
  CHECK(room->cut_height() < 2.6);
  CHECK(room->cut_height() > 2.2);
}

TEST_CASE("the room is found from half a metre before a window") {
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const glm::vec3 x(4.5f, 0, 0), y(0, 1, 0), z(0, 0, 3);
  for (const float height : {0.0f, 2.5f}) builder.grid({-0.5f, height, 0}, z, x, 1, white);
  for (const float end : {0.0f, 3.0f}) builder.grid({-0.5f, 0, end}, x, 2.5f * y, 1, white);
  builder.grid({4, 0, 0}, 2.5f * y, z, 1, white);
  builder.grid({0, 0, 0}, y, z, 1, white);         // below the window,
  builder.grid({0, 2, 0}, 0.5f * y, z, 1, white);  // above it,
  builder.grid({-0.2f, 1, 0}, y, z, 1, white);     // and its pane
  const Scene scene = builder.build();
  const RayScene rays(scene);
  // The ceiling is looked for at points a fifth of the height aside, too: here in the wall's plane.
  const auto room = trace::Room::around(rays, trace::PlanAxes(), {0.5, 1.6, 1.5});
  REQUIRE(room.has_value());
  CHECK(static_cast<double>(room->positions().size()) * room->cell_area() ==
        Approx(4 * 3).epsilon(0.1));
}

TEST_CASE("a room that is open on one side is seen through it, and anything else from above") {
  const int open = GENERATE(-1, 0, 1, 2, 3);  // the wall left out: none, at +z, -z, +x, -x
  SceneBuilder builder;
  const std::uint32_t white = builder.add(diffuse(0.5f));
  const glm::vec3 none(0), x(4, 0, 0), y(0, 3, 0), z(0, 0, 5);
  builder.grid(none, z, x, 1, white);
  if (open < 0) {
    builder.box({1, 0, 1}, {2, 3, 2}, white, false);
  } else {
    builder.grid(y, x, z, 1, white);
    if (open != 0) builder.grid(z, y, x, 1, white);
    if (open != 1) builder.grid(none, x, y, 1, white);
    if (open != 2) builder.grid(x, z, y, 1, white);
    if (open != 3) builder.grid(none, y, z, 1, white);
  }
  const Camera camera = builder.build().cameras.at(0);
  const glm::dvec3 middle(2, 1.5, 2.5);
  const glm::dvec3 outwards[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
  const glm::dvec3 from = glm::normalize(camera.position - middle);
  CHECK(glm::distance(camera.forward, -from) < 1e-12);
  // What is seen, the open side or all, fills a picture of 4:3, or most of it.
  double widest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point(corner & 1 ? 4 : 0, corner & 2 ? 3 : 0, corner & 4 ? 5 : 0);
    if (open >= 0 && glm::dot(point - middle, from) < 0) continue;
    const glm::dvec3 to = point - camera.position;
    const double half =
        std::tan(0.5 * camera.vertical_field_of_view) * glm::dot(to, camera.forward);
    CHECK(half > 0);
    widest = std::max({widest, std::abs(glm::dot(to, camera.up)) / half,
                       std::abs(glm::dot(to, camera.right)) / half * 3 / 4});
  }
  if (open >= 0) {
    CHECK(glm::distance(from, outwards[open]) < 1e-12);
    CHECK(widest == Approx(1));
  } else {
    CHECK(from.y > 0);
    CHECK(from.z > 0);
    CHECK(widest <= 1);
    CHECK(widest > 0.6);
  }
}

}  // namespace photile::test
