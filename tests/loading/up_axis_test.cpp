// Scenes whose files have another axis pointing up: turned at import, and told where they look so.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <functional>

#include "measuring/working_plane.hpp"
#include "photile/sensors.hpp"
#include "photometric_texts.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

struct World {
  std::string up;
  std::function<glm::dvec3(const glm::dvec3&)> file;  ///< of a place of a y-up scene
};

/// Worked out by hand: x stays to the right, or y where x is the height, and the turn is no mirror.
const World worlds[]{
    {"y", [](const glm::dvec3& p) { return p; }},
    {"z", [](const glm::dvec3& p) { return glm::dvec3(p.x, -p.z, p.y); }},
    {"-z", [](const glm::dvec3& p) { return glm::dvec3(p.x, p.z, -p.y); }},
    {"-y", [](const glm::dvec3& p) { return glm::dvec3(p.x, -p.y, -p.z); }},
    {"x", [](const glm::dvec3& p) { return glm::dvec3(p.y, p.x, -p.z); }},
    {"-x", [](const glm::dvec3& p) { return glm::dvec3(-p.y, p.x, p.z); }},
};

const std::string white = "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";

/// A room of `size` (y is up) with walls that face inwards and a small lamp below its ceiling.
std::string room(const glm::dvec3& size, const std::function<glm::dvec3(const glm::dvec3&)>& file) {
  std::string text;
  const auto vertex = [&](const glm::dvec3& p) {
    const glm::dvec3 q = file(p);
    text += fmt::format("v {} {} {}\n", q.x, q.y, q.z);
  };
  for (int i = 0; i < 8; ++i) {
    vertex(size * glm::dvec3(i & 1, i >> 1 & 1, i >> 2 & 1));
  }
  for (const auto& [x, z] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
    vertex({1 + 0.4 * x, size.y - 0.1, 1 + 0.3 * z});
  }
  return text +
         "o walls\nusemtl wall\nf 1 5 6 2\nf 3 4 8 7\nf 1 2 4 3\nf 5 7 8 6\nf 1 3 7 5\nf 2 6 8 4\n"
         "o lamp\nusemtl lamp\nf 9 10 11 12\n";
}

SceneLoadOptions up(const std::string& axis) {
  SceneLoadOptions options;
  options.up = axis;
  return options;
}

}  // namespace

TEST_CASE("a scene of any up axis becomes the same y-up scene, not mirrored", "[up]") {
  const glm::dvec3 size(6, 2.8, 5);
  const Scene plain = load_obj(room(size, worlds[0].file), white, up("y"));
  for (const World& world : worlds) {
    CAPTURE(world.up);
    const Scene scene = load_obj(room(size, world.file), white, up(world.up));
    REQUIRE(scene.vertices == plain.vertices);
    CHECK(scene.triangles == plain.triangles);
    CHECK(scene.front_side == plain.front_side);
    CHECK(glm::determinant(scene.turn) == Approx(1));
    const glm::dvec3 place(0.3, 1.1, 2.5);
    CHECK(glm::distance(position_in_scene(scene, world.file(place)), place) < 1e-12);
    CHECK(glm::distance(position_in_world(scene, place), world.file(place)) < 1e-12);
    CHECK(glm::distance(direction_in_world(scene, {0, 1, 0}), world.file({0, 1, 0})) < 1e-12);
    const Camera there = in_world(scene, scene.cameras.front());
    CHECK(glm::distance(in_scene(scene, there).forward, scene.cameras.front().forward) < 1e-12);
  }
}

TEST_CASE("grids lie in the file's world, whatever points up there", "[up]") {
  for (const World& world : worlds) {
    CAPTURE(world.up);
    const Scene scene = load_obj(room({6, 2.8, 5}, world.file), white, up(world.up));
    measuring::WorkingPlane plane = measuring::parse_working_plane("floor+0.75");
    plane.inside = world.file({3, 1, 2});
    const auto grid = measuring::working_plane_grid(scene, plane);
    REQUIRE(grid.sensors.size() > 10);
    for (const Sensor& sensor : grid.sensors) {
      CHECK(glm::dot(sensor.position, world.file({0, 1, 0})) == Approx(0.75));
      CHECK(glm::distance(sensor.normal, world.file({0, 1, 0})) < 1e-12);
      CHECK(in_scene(scene, sensor).position.y == Approx(0.75));
    }
  }
}

TEST_CASE("placed lamps have their place and aim in the file's world", "[up]") {
  const SceneFolderOnDisk folder;
  folder.write("materials.mtl", white);
  IesText lamp;
  lamp.vertical = angles(0, 90, 90);
  folder.write("lamp.ies", lamp.str());
  SceneLoadOptions options = up("z");
  options.luminaires = folder.write(
      "lamps.json",
      R"({"file": "lamp.ies", "position": [2, 3, 2.5], "aim": [0, 0, -1], "size": [1.2, 0.3]})");
  const Scene scene = load_scene(
      folder.write("room.obj", "mtllib materials.mtl\n" + room({6, 2.8, 5}, worlds[1].file)),
      options);
  const Light& light = scene.lights.back();
  CHECK(light.direction.y == Approx(-1));
  REQUIRE(light.triangles.size() == 2);
  for (const std::uint32_t triangle : light.triangles) {
    for (const glm::vec3& corner : scene.corners(triangle)) {
      const glm::dvec3 place = position_in_world(scene, glm::dvec3(corner));
      CHECK(place.z == Approx(2.5));
      CHECK(std::abs(place.x - 2) == Approx(0.6));
      CHECK(std::abs(place.y - 3) == Approx(0.15));
    }
  }
}

TEST_CASE("the root of a glTF file is turned, with all that hangs on it", "[up]") {
  const Scene scene = load_gltf(square_document(), up("z"));  // it faces +z in the file
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    CHECK(sided_normal(scene, sided(t, scene.front_side[t])).y == Approx(1));
  }
}

TEST_CASE("a room that lies on its side is told with the remedy, and is not turned", "[up]") {
  const auto warnings = [](const glm::dvec3& size, const World& world, const std::string& axis) {
    return load_obj(room(size, world.file), white, up(axis)).report.warnings;
  };
  const auto told = warnings({6, 2.8, 5}, worlds[1], "");
  REQUIRE(told.size() == 1);
  CHECK_THAT(told.front(), Contains("--set up=z") && Contains("60"));  // m2 of floor and ceiling
  CHECK(warnings({6, 2.8, 5}, worlds[1], "z").empty());
  CHECK(warnings({6, 2.8, 5}, worlds[1], "y").empty());
  // What stands upright: a room, a corridor, and a wall alone.
  CHECK(warnings({6, 2.8, 5}, worlds[0], "").empty());
  CHECK(warnings({12, 2.5, 1.6}, worlds[0], "").empty());
  CHECK(load_obj(unit_square + "usemtl lamp\nf 1 2 3 4\n", lamp_and_wall).report.warnings.empty());
}

TEST_CASE("an axis that is none is refused", "[up]") {
  CHECK_THROWS_WITH(load_obj(room({6, 2.8, 5}, worlds[0].file), white, up("w")),
                    Contains("'w'") && Contains("-z"));
}

}  // namespace photile::test
