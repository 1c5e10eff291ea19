// Coordinates are read in double precision and counted from an origin near the triangles.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "garbage.hpp"
#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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
    const std::string text = test::garbage_obj(seed);
    CAPTURE(seed, text);
    try {
      const Scene scene = load_obj(text, lamp_and_wall);
      ++loaded;
      for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
        for (const glm::vec3& corner : scene.corners(t)) {
          REQUIRE(glm::length(scene.origin + glm::dvec3(corner)) <= 4 * limits::max_coordinate);
        }
        REQUIRE(triangle_area(scene, t) > 0);
        REQUIRE(std::isfinite(glm::length(sided_normal(scene, sided(t, 0)))));
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
