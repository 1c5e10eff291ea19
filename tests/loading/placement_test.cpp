// Cameras, axes and coordinates of scene files.

#include <catch2/catch.hpp>

#include "garbage.hpp"
#include "measuring/working_plane.hpp"
#include "photile/limits.hpp"
#include "photile/sensors.hpp"
#include "photometric_texts.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;

void check_vector(const glm::dvec3& actual, const glm::dvec3& expected) {
  CHECK(glm::length(actual - expected) < 1e-9);
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

TEST_CASE("a glTF camera looks along -z of its node, and scale does not change it") {
  json document = square_document();
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

// Scenes whose files have another axis pointing up: turned at import, and told where they look so.

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

TEST_CASE("a scene of any up axis becomes the same y-up scene, not mirrored") {
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

TEST_CASE("grids lie in the file's world, whatever points up there") {
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

TEST_CASE("placed lamps have their place and aim in the file's world") {
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

TEST_CASE("the root of a glTF file is turned, with all that hangs on it") {
  const Scene scene = load_gltf(square_document(), up("z"));  // it faces +z in the file
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    CHECK(front_of(scene, t).y == Approx(1));
  }
}

TEST_CASE("a room that lies on its side is told with the remedy, and is not turned") {
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

// Files in another unit of length: scaled as asked, and told where they look so.

std::function<glm::dvec3(const glm::dvec3&)> times(double factor) {
  return [factor](const glm::dvec3& p) { return factor * p; };
}

TEST_CASE("a room in millimetres becomes the room in metres") {
  SceneLoadOptions millimetres;
  millimetres.metres_per_unit = 1e-3;
  const Scene metres = load_obj(room({6, 2.8, 5}, worlds[0].file), white, {});
  const Scene scaled = load_obj(room({6, 2.8, 5}, times(1000)), white, millimetres);
  REQUIRE(scaled.vertices.size() == metres.vertices.size());
  for (std::size_t i = 0; i < metres.vertices.size(); ++i) {
    const glm::dvec3 there = glm::dvec3(scaled.vertices[i]) + scaled.origin;
    CHECK(glm::distance(there, glm::dvec3(metres.vertices[i]) + metres.origin) < 1e-5);
  }
}

TEST_CASE("a scene of a doubtful size is told with the units that make a room of it") {
  const auto warnings = [](double factor, double metres_per_unit) {
    SceneLoadOptions options;
    options.metres_per_unit = metres_per_unit;
    return load_obj(room({6, 2.8, 5}, times(factor)), white, options).report.warnings;
  };
  const auto millimetres = warnings(1000, 1);
  REQUIRE(millimetres.size() == 1);
  CHECK_THAT(millimetres.front(), Contains("6000 m") && Contains("--set units=mm makes it 6 m"));
  const auto inches = warnings(1 / 0.0254, 1);
  REQUIRE(inches.size() == 1);
  CHECK_THAT(inches.front(), Contains("--set units=in makes it 6 m"));
  CHECK(warnings(1, 1).empty());
  CHECK(warnings(20, 1).empty());
  CHECK(warnings(1000, 1e-3).empty());
  CHECK_THAT(warnings(0.001, 1).front(), Contains("0.006 m") && Contains("--set units"));
}

TEST_CASE("a glTF file in centimetres has its triangles and cameras in metres") {
  json document = square_document();
  document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  document["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {50, 60, 300}}});
  document["scenes"][0]["nodes"] = {0, 1};
  SceneLoadOptions centimetres = up("z");
  centimetres.metres_per_unit = 0.01;
  const Scene scene = load_gltf(document, centimetres);
  // A square metre in the file.
  CHECK(triangle_area(scene, 0) == Approx(0.5e-4));
  const glm::dvec3 eye = in_world(scene, scene.cameras.front()).position;
  CHECK(glm::distance(eye, glm::dvec3(0.5, 0.6, 3)) < 1e-6);
}

// Coordinates are read in double precision and counted from an origin near the triangles.

/// `v` lines of points moved by `offset`, with every digit of a double.
std::string vertices(const std::vector<glm::dvec3>& points, const glm::dvec3& offset) {
  std::string text;
  for (const glm::dvec3& p : points) {
    text +=
        fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x + offset.x, p.y + offset.y, p.z + offset.z);
  }
  return text;
}

/// How far a scene's triangles, in the file's world, lie from the given corners.
double largest_error(const Scene& scene, const std::vector<glm::dvec3>& points,
                     const glm::dvec3& offset) {
  double largest = 0;
  for (const glm::vec3& vertex : scene.vertices) {
    double nearest = INFINITY;
    for (const glm::dvec3& p : points) {
      nearest = std::min(nearest, glm::distance(scene.origin + glm::dvec3(vertex), p + offset));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

const std::vector<glm::dvec3> small_square = {{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.7, 0}, {0, 0.7, 0}};
const std::string lamp_face = "usemtl lamp\nf 1 2 3 4\n";

TEST_CASE("origin: a scene around the file's origin keeps its coordinates") {
  const Scene scene = load_obj(vertices(small_square, {8, -3, 20}) + lamp_face, lamp_and_wall);
  CHECK(scene.origin == glm::dvec3(0));
}

TEST_CASE("origin: an OBJ a thousand kilometres off loses nothing") {
  // A national grid: easting, northing, height.
  for (const glm::dvec3& offset :
       {glm::dvec3(1e6, 0, 0), glm::dvec3(691'607.25, 5'334'760.5, 519.1),
        glm::dvec3(-1e6, 1e6, -1e6)}) {
    const Scene scene = load_obj(vertices(small_square, offset) + lamp_face, lamp_and_wall);
    REQUIRE(scene.triangle_count() == 2);
    CHECK(glm::distance(scene.origin, offset) < 1.0);
    // Doubles of 5e6 are right to 5e-10; floats would be wrong by 0.25.
    CHECK(largest_error(scene, small_square, offset) < 1e-7);
    CHECK(triangle_area(scene, 0) == Approx(0.105).epsilon(1e-6));
    // The camera that the import places is near the scene, in its coordinates.
    CHECK(glm::length(scene.cameras[0].position) < 10);
    CHECK(glm::distance(in_world(scene, scene.cameras[0]).position, offset) < 10);
  }
}

TEST_CASE("origin: a hall ten kilometres off is as exact as one at the file's origin") {
  const std::vector<glm::dvec3> hall = {{0, 0, 0}, {12, 0, 0}, {12, 14, 0}, {0, 14, 0}};
  const glm::dvec3 offset(10'000.3, 5.1, 5'000.7);
  const Scene scene = load_obj(vertices(hall, offset) + lamp_face, lamp_and_wall);
  CHECK(glm::distance(scene.origin, offset) < 20);
  CHECK(largest_error(scene, hall, offset) < 1e-5);  // rounded at 10 km: 5e-4
}

TEST_CASE("origin: glTF nodes far off, with their camera and lamp") {
  json document = square_document();
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 100}, {"name", "bulb"}}};
  document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 1}}}}};
  document["nodes"] = {
      {{"name", "site"}, {"translation", {1e6, -2e6, 3e5}}, {"children", {1, 2, 3}}},
      {{"name", "panel"}, {"mesh", 0}, {"scale", {0.1, 0.1, 0.1}}},
      {{"name", "bulb"},
       {"translation", {0.1, 0.2, 0.3}},
       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
      {{"name", "eye"}, {"translation", {0.05, 0.05, 2.0}}, {"camera", 0}}};
  const Scene scene = load_gltf(document);
  REQUIRE(scene.triangle_count() == 2);
  const glm::dvec3 site(1e6, -2e6, 3e5);
  CHECK(glm::distance(scene.origin, site) < 1.0);
  for (const glm::vec3& vertex : scene.vertices) {
    const glm::dvec3 local = scene.origin + glm::dvec3(vertex) - site;
    CHECK(std::min(std::abs(local.x), std::abs(local.x - 0.1)) < 1e-7);
    CHECK(std::min(std::abs(local.y), std::abs(local.y - 0.1)) < 1e-7);
    CHECK(std::abs(local.z) < 1e-7);
  }
  const auto bulb = std::find_if(scene.lights.begin(), scene.lights.end(),
                                 [](const Light& light) { return light.kind == LightKind::point; });
  REQUIRE(bulb != scene.lights.end());
  CHECK(glm::distance(scene.origin + glm::dvec3(bulb->position), site + glm::dvec3(0.1, 0.2, 0.3)) <
        1e-7);
  REQUIRE(scene.cameras.size() == 1);
  CHECK(glm::distance(in_world(scene, scene.cameras[0]).position,
                      site + glm::dvec3(0.05, 0.05, 2.0)) < 1e-7);
}

TEST_CASE("origin: a lamp of a millimetre in a landscape of 1e5 m keeps its shape") {
  const std::vector<glm::dvec3> ground = {{0, 0, 0}, {1e5, 0, 0}, {1e5, 1e5, 0}, {0, 1e5, 0}};
  const glm::dvec3 place(31'234.5678, 71'717.1717, 40'000);
  std::vector<glm::dvec3> lamp = small_square;
  for (glm::dvec3& p : lamp) p = place + 1e-3 * p;
  const Scene scene = load_obj(vertices(lamp, glm::dvec3(0)) + vertices(ground, glm::dvec3(0)) +
                                   lamp_face + "usemtl wall\nf 5 6 7 8\n",
                               lamp_and_wall);
  REQUIRE(scene.triangle_count() == 4);
  CHECK(glm::distance(scene.origin, place) < 0.01);
  CHECK(triangle_area(scene, 0) + triangle_area(scene, 1) == Approx(0.21e-6).epsilon(1e-5));
  std::vector<glm::dvec3> all = lamp;
  all.insert(all.end(), ground.begin(), ground.end());
  CHECK(largest_error(scene, all, glm::dvec3(0)) < 0.01);  // the ground's, by a float's rounding
}

TEST_CASE("origin: corners that are no places do not move it, and are dropped beyond the limit") {
  std::string text = vertices(small_square, {1e6, 1e6, 1e6});
  text += "v nan 0 0\nv 1e300 0 0\nv 1e13 0 0\nv 0 1e13 1\n";
  const Scene scene =
      load_obj(text + lamp_face + "f 1 2 5\nf 1 2 6\nf 1 2 7\nf 1 2 8\nf 7 8 6\n", lamp_and_wall);
  CHECK(scene.triangle_count() == 2);
  CHECK(scene.report.non_finite_triangles == 5);
  CHECK(glm::distance(scene.origin, glm::dvec3(1e6)) < 1.0);
  CHECK(warns(scene, {"5 triangles", "1e+12 m"}));
}

TEST_CASE("garbage OBJ files are refused in a line, or give a scene of sound triangles") {
  int loaded = 0;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    const std::string text = garbage_obj(seed);
    CAPTURE(seed, text);
    try {
      const Scene scene = load_obj(text, lamp_and_wall);
      ++loaded;
      for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
        for (const glm::vec3& corner : scene.corners(t)) {
          REQUIRE(glm::length(scene.origin + glm::dvec3(corner)) <= 4 * limits::max_coordinate);
        }
        REQUIRE(triangle_area(scene, t) > 0);
        REQUIRE(std::isfinite(glm::length(face_normal(scene, oriented(t, 0)))));
      }
      for (const Light& light : scene.lights) REQUIRE(std::isfinite(light.power));
      REQUIRE(std::isfinite(glm::length(scene.cameras.at(0).position)));
    } catch (const InputError& error) {
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(loaded >= 500);
}

}  // namespace
}  // namespace photile::test
