#include "scene/camera.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene_files.hpp"

namespace photile::test {
namespace {

void check_vector(const glm::dvec3& actual, const glm::dvec3& expected) {
  CHECK(glm::length(actual - expected) < 1e-9);
}

/// Position of a point in the picture, both from -1 to 1 with (-1, 1) the upper left corner;
/// outside that range, or with a negative depth, it is not seen.
glm::dvec3 projected(const Camera& camera, const glm::dvec3& point, double aspect) {
  const glm::dvec3 d = point - camera.position;
  const double depth = glm::dot(d, camera.forward);
  const double half = std::tan(0.5 * camera.vertical_field_of_view) * depth;
  return {glm::dot(d, camera.right) / (half * aspect), glm::dot(d, camera.up) / half, depth};
}

TEST_CASE("a camera that looks at a point has a right-handed orthonormal frame") {
  const Camera camera = Camera::look_at({1, 2, 3}, {4, -1, 2}, {0, 1, 0}, 1.0);
  check_vector(camera.right, glm::cross(camera.forward, camera.up));
  check_vector(camera.forward, glm::normalize(glm::dvec3(3, -3, -1)));
  CHECK(glm::length(camera.up) == Approx(1.0));
  CHECK(camera.up.y > 0.0);
}

TEST_CASE("a camera that looks along its up hint still has a frame") {
  const Camera camera = Camera::look_at({0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1.0);
  check_vector(camera.forward, {0, -1, 0});
  check_vector(camera.right, glm::cross(camera.forward, camera.up));
}

TEST_CASE("rays of a camera meet the corners of its film where the field of view says") {
  Camera camera;  // at the origin, towards -z
  camera.vertical_field_of_view = glm::radians(90.0);
  check_vector(camera.direction(100, 50, 200, 100), {0, 0, -1});
  check_vector(camera.direction(0, 0, 200, 100), glm::normalize(glm::dvec3(-2, 1, -1)));
  check_vector(camera.direction(200, 100, 200, 100), glm::normalize(glm::dvec3(2, -1, -1)));
}

/// A box of unit side around (0.5, 0.5, 0.5) without the sides that `open` names.
std::string box(const std::string& open) {
  std::string obj =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl lamp\n";
  if (open != "-z") obj += "f 1 2 3 4\n";
  if (open != "+z") obj += "f 5 6 7 8\n";
  if (open != "-x") obj += "f 1 4 8 5\n";
  if (open != "+x") obj += "f 2 3 7 6\n";
  return obj + "f 1 2 6 5\nf 4 3 7 8\n";
}

TEST_CASE("a room with an open side is framed through that side from outside") {
  const std::vector<std::pair<std::string, glm::dvec3>> sides{
      {"-z", {0, 0, 1}}, {"+z", {0, 0, -1}}, {"-x", {1, 0, 0}}, {"+x", {-1, 0, 0}}};
  for (const auto& [open, forward] : sides) {
    const Scene scene = load_obj(box(open), lamp_and_wall);
    REQUIRE(scene.cameras.size() == 1);
    const Camera& camera = scene.cameras[0];
    check_vector(camera.forward, forward);
    // The opening spans the picture's height: its edges are at +-1.
    const glm::dvec3 lip = glm::dvec3(0.5) - 0.5 * forward;
    CHECK(projected(camera, lip + glm::dvec3(0, 0.5, 0), 4.0 / 3.0).y == Approx(1.0));
    CHECK(projected(camera, lip, 4.0 / 3.0).z > 0.0);
  }
}

TEST_CASE("a closed room is seen from the inside") {
  const Scene scene = load_obj(box("none"), lamp_and_wall);
  const Camera& camera = scene.cameras[0];
  CHECK(glm::all(glm::greaterThan(camera.position, glm::dvec3(0.0))));
  CHECK(glm::all(glm::lessThan(camera.position, glm::dvec3(1.0))));
  CHECK(glm::dot(glm::dvec3(0.5) - camera.position, camera.forward) > 0.0);
}

TEST_CASE("an object without a room is seen whole from outside") {
  const Scene scene = load_obj(unit_square + "usemtl lamp\nf 1 2 3 4\n", lamp_and_wall);
  for (const glm::vec3& vertex : scene.vertices) {
    const glm::dvec3 seen = projected(scene.cameras[0], glm::dvec3(vertex), 1.0);
    CHECK(std::abs(seen.x) <= 1.0);
    CHECK(std::abs(seen.y) <= 1.0);
    CHECK(seen.z > 0.0);
  }
}

TEST_CASE("a glTF camera looks along -z of its node, and scale does not change it") {
  nlohmann::json document = square_document();
  document["cameras"] = {{{"type", "perspective"},
                          {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 0.1}}}}};
  // A quarter turn about y: -z becomes -x.
  const double h = std::sqrt(0.5);
  document["nodes"].push_back({{"name", "eye"},
                               {"camera", 0},
                               {"translation", {1, 2, 3}},
                               {"rotation", {0, h, 0, h}},
                               {"scale", {2, 2, 2}}});
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load_gltf(document);
  REQUIRE(scene.cameras.size() == 1);
  const Camera& camera = scene.cameras[0];
  CHECK(camera.name == "eye");
  CHECK(camera.position == glm::dvec3(1, 2, 3));
  check_vector(camera.forward, {-1, 0, 0});
  check_vector(camera.up, {0, 1, 0});
  check_vector(camera.right, {0, 0, -1});
  CHECK(camera.vertical_field_of_view == 0.7);
  CHECK(camera.aspect_ratio == 1.5);
}

TEST_CASE("an orthographic glTF camera is skipped by name and replaced") {
  nlohmann::json document = square_document();
  document["cameras"] = {{{"type", "orthographic"},
                          {"name", "plan"},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 1}}}}};
  document["nodes"][0]["camera"] = 0;
  const Scene scene = load_gltf(document);
  CHECK(warns(scene, {"panel", "perspective"}));
  REQUIRE(scene.cameras.size() == 1);
  CHECK(scene.cameras[0].name == "default");
}

}  // namespace
}  // namespace photile::test
