// OBJ and MTL files.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "loading/load_scene.hpp"
#include "reading/triangles.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

TEST_CASE("--set hide leaves out objects and groups of an OBJ") {
  const std::string obj = unit_square +
                          "o lamp\nusemtl lamp\nf 1 2 3 4\n"
                          "v 0 0 1\nv 1 0 1\nv 1 1 1\no haze\nusemtl wall\nf 5 6 7\n";
  SceneLoadOptions options;
  CHECK(load_obj(obj, lamp_and_wall, options).triangle_count() == 3);
  options.hidden = {"ha?e"};
  const Scene scene = load_obj(obj, lamp_and_wall, options);
  CHECK(scene.triangle_count() == 2);
  REQUIRE(scene.report.meshes.size() == 1);
  CHECK(scene.report.meshes[0].name == "lamp");
}

TEST_CASE("an OBJ square becomes two triangles of area 1 that face its winding's side") {
  const Scene scene = load_obj(unit_square + "o panel\nusemtl lamp\nf 1 2 3 4\n", lamp_and_wall);
  REQUIRE(scene.triangle_count() == 2);
  CHECK(scene.report.polygons_triangulated == 1);
  CHECK(total_area(scene) == Approx(1.0));
  for (std::uint32_t t = 0; t < 2; ++t) CHECK(front_of(scene, t).z == Approx(1.0));
}

TEST_CASE("OBJ emission is watts, from the front only: pi * area * luminance") {
  const Scene scene =
      load_obj(unit_square + "o panel\nusemtl lamp\nf 1 2 3 4\n", "newmtl lamp\nKe 1 2 3\n");
  CHECK(scene.unit == PowerUnit::watt);
  REQUIRE(scene.lights.size() == 1);
  const double expected = 0.2126 * 1 + 0.7152 * 2 + 0.0722 * 3;
  CHECK(scene.lights[0].power == Approx(std::numbers::pi * expected));
  CHECK_FALSE(scene.lights[0].two_sided);
  CHECK(luminance(glm::dvec3(scene.lights[0].color)) == Approx(1.0));
  CHECK(scene.lights[0].color.b / scene.lights[0].color.r == Approx(3.0));
  CHECK(scene.lights[0].triangles == std::vector<std::uint32_t>{0, 1});
  CHECK(scene.triangle_light == std::vector<std::uint32_t>{0, 0});
}

TEST_CASE("each OBJ object with an emissive material is a light of its own, by name") {
  const std::string far = "v 0 0 5\nv 1 0 5\nv 0 1 5\n";
  const Scene scene = load_obj(unit_square + far +
                                   "o desk.lamp\nusemtl lamp\nf 1 2 3\nusemtl wall\nf 1 3 4\n"
                                   "o window\nusemtl lamp\nf 5 6 7\n"
                                   "o desk.lamp\nusemtl lamp\nf 1 2 4\n",
                               lamp_and_wall);
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].name == "desk_lamp");
  CHECK(scene.lights[0].triangles == std::vector<std::uint32_t>{0, 3});
  CHECK(scene.lights[1].name == "window");
  CHECK(scene.triangle_light == std::vector<std::uint32_t>{0, none, 1, 0});
}

TEST_CASE("emissive_scale multiplies emission") {
  SceneLoadOptions options;
  options.emissive_scale = 683.0f;
  const std::string obj = unit_square + "usemtl lamp\nf 1 2 3 4\n";
  CHECK(load_obj(obj, lamp_and_wall, options).lights[0].power ==
        Approx(683.0 * load_obj(obj, lamp_and_wall).lights[0].power));
}

TEST_CASE("a concave OBJ polygon keeps its area, against the shoelace value") {
  const Scene scene = load_obj(
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nusemtl lamp\nf 1 2 3 4 5\n", lamp_and_wall);
  REQUIRE(scene.triangle_count() == 3);
  CHECK(total_area(scene) == Approx(2.5));
}

TEST_CASE("an OBJ polygon of more corners than a byte counts keeps its area") {
  std::string obj, face = "f";
  constexpr int corners = 300;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    obj += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  const Scene scene = load_obj(obj + "usemtl lamp\n" + face + "\n", lamp_and_wall);
  CHECK(scene.triangle_count() == corners - 2);
  const double area = 0.5 * corners * std::sin(2.0 * std::numbers::pi / corners);
  CHECK(scene.lights[0].power == Approx(2.0 * std::numbers::pi * area).epsilon(1e-5));
}

TEST_CASE("faces with negative and continued indices are read") {
  const Scene scene = load_obj(unit_square + "usemtl lamp\nf -4 -3 \\\n -2\n", lamp_and_wall);
  REQUIRE(scene.triangle_count() == 1);
  CHECK(triangle_area(scene, 0) == Approx(0.5));
}

/// Material m of an MTL text, beside a lamp. Warnings go to `report` where given.
Material mtl_material(const std::string& statements, Scene* report = nullptr) {
  Scene scene = load_obj(unit_square + "usemtl lamp\nf 1 2 3\nusemtl m\nf 1 3 4\n",
                         "newmtl lamp\nKe 1 1 1\nnewmtl m\n" + statements);
  const Material result = scene.materials[scene.triangle_material[1]];
  if (report != nullptr) *report = std::move(scene);
  return result;
}

TEST_CASE("MTL Ks without a specular illumination model is diffuse only") {
  const Material m = mtl_material("Kd 0.5 0.25 0.125\nKs 0.3 0.3 0.3\nNs 50\nillum 1\n");
  CHECK(m.interaction == Interaction::opaque);
  CHECK(m.diffuse == glm::vec3(0.5f, 0.25f, 0.125f));
  CHECK_FALSE(m.glossy());
}

TEST_CASE("MTL illum 2 is glossy with GGX alpha sqrt(2 / (Ns + 2))") {
  const Material m = mtl_material("Kd 0.5 0.5 0.5\nKs 0.2 0.3 0.4\nNs 30\nillum 2\n");
  CHECK(m.glossy());
  CHECK(m.specular == glm::vec3(0.2f, 0.3f, 0.4f));
  CHECK(m.roughness == Approx(0.25));
}

TEST_CASE("MTL illum 3 with a sharp lobe or without a diffuse part is a mirror") {
  CHECK(mtl_material("Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 1000\nillum 3\n").interaction ==
        Interaction::mirror);
  const Material black = mtl_material("Kd 0 0 0\nKs 0.8 0.7 0.6\nNs 10\nillum 5\n");
  CHECK(black.interaction == Interaction::mirror);
  CHECK(black.specular == glm::vec3(0.8f, 0.7f, 0.6f));
  CHECK(black.diffuse == glm::vec3(0.0f));
  CHECK(mtl_material("Kd 0.4 0.4 0.4\nKs 0.3 0.3 0.3\nNs 10\nillum 3\n").interaction ==
        Interaction::opaque);
}

TEST_CASE("MTL glass models and transparency with Ni are glass of that index") {
  for (const std::string model :
       {"illum 4\n", "illum 6\n", "illum 7\n", "illum 9\n", "d 0.2\n", "Tr 0.8\n"}) {
    const Material m = mtl_material("Kd 1 1 1\nNi 1.33\nTf 0.9 0.8 0.7\n" + model);
    CHECK(m.interaction == Interaction::glass);
    CHECK(m.index_of_refraction == 1.33f);
    CHECK(m.transmission == glm::vec3(0.9f, 0.8f, 0.7f));
  }
  CHECK(mtl_material("illum 7\n").index_of_refraction == 1.5f);
  CHECK(mtl_material("Kd 1 1 1\nNi 1.33\nd 1\n").interaction == Interaction::opaque);
}

TEST_CASE("MTL roughness and metallic factors are used where present") {
  const Material m = mtl_material("Kd 0.5 0.5 0.5\nPr 0.5\nPm 1\n");
  CHECK(m.diffuse == glm::vec3(0.0f));
  CHECK(m.specular == glm::vec3(0.5f));
  CHECK(m.roughness == Approx(0.25));
}

/// A picture of one texel, written by hand (PPM).
std::string one_texel(const std::string& rgb) { return "P6\n1 1\n255\n" + rgb; }

TEST_CASE("an MTL texture without Kd has its own colours, whatever materials come before") {
  const SceneFolderOnDisk folder;
  folder.write("my texture.ppm", one_texel("\xBC\xBC\xBC"));
  const std::string before = GENERATE("", "newmtl other\nKd 0.25 0.25 0.25\n");
  const std::string map = GENERATE("map_Kd my texture.ppm", "MAP_KD\t-s 1 1 1 my texture.ppm",
                                   "map_Kd -o 0 0 -mm 0 1 \"my texture.ppm\"");
  folder.write("materials.mtl", before + "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl photo\n" + map);
  const Scene scene = load_scene(
      folder.write("s.obj", "mtllib materials.mtl\n" + unit_square +
                                "usemtl photo\nf 1/1 2/2 3/3\nusemtl lamp\nf 1/1 3/3 4/4\n"));
  const Material& photo = scene.materials.at(0);
  CHECK(photo.diffuse == glm::vec3(1.0f));
  REQUIRE(photo.diffuse_texture != none);
  CHECK(scene.textures[photo.diffuse_texture].sample({0.5f, 0.5f}).g == Approx(0.50289));
}

TEST_CASE("MTL colours of one number, in any case and of CIE XYZ are read") {
  CHECK(mtl_material("Kd 0.25\n").diffuse == glm::vec3(0.25f));
  CHECK(mtl_material("KD 0.25 0.5 0.125 # oak\n").diffuse == glm::vec3(0.25f, 0.5f, 0.125f));
  CHECK(mtl_material("\tkd\t.25\t+0.5\t1e-1\r\n").diffuse.r == 0.25f);
  CHECK(mtl_material("Kd 0.25 \\\n 0.5 0.125").diffuse.b == 0.125f);
  // Y is the luminance, of whatever colour, and one number is grey.
  CHECK(luminance(glm::dvec3(mtl_material("Kd xyz 0.3 0.4 0.2\n").diffuse)) ==
        Approx(0.4).epsilon(1e-4));
  const glm::vec3 grey = mtl_material("Kd xyz 0.5\n").diffuse;
  CHECK(grey.r == Approx(0.5));
  CHECK(grey.b == Approx(0.5));
  CHECK(mtl_material("illum 7\nTf 0.5\n").transmission == glm::vec3(0.5f));
}

TEST_CASE("materials that scatter in one way cost nothing elsewhere") {
  Scene scene;
  mtl_material("Kd 1 1 1\n", &scene);
  CHECK_FALSE(needs_of(scene).glossy);
  CHECK_FALSE(needs_of(scene).textures);
  CHECK_FALSE(needs_of(scene).specular_paths);
  CHECK(needs_of(scene).light_count == 1);
  CHECK(scene.corner_uv.empty());
  CHECK(scene.corner_normal.empty());
  mtl_material("illum 7\n", &scene);
  CHECK(needs_of(scene).specular_paths);
}

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return 0.5 * glm::cross(b - a, c - a);
}

/// Checks that the triangles tile a planar polygon: their oriented areas all point the polygon's
/// way, and sum to its area by the shoelace formula.
void check_tiling(const std::vector<glm::dvec3>& polygon) {
  const reading::Triangulation result = reading::triangulate_polygon(polygon);
  CHECK(result.simple);
  CHECK(result.triangles.size() == polygon.size() - 2);
  glm::dvec3 expected(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    expected += 0.5 * glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  double sum = 0.0;
  for (const auto& [a, b, c] : result.triangles) {
    const glm::dvec3 area = area_vector(polygon[a], polygon[b], polygon[c]);
    CHECK(glm::dot(area, expected) >= -1e-12);
    sum += glm::length(area);
  }
  CHECK(sum == Approx(glm::length(expected)).epsilon(1e-9));
}

/// A star polygon around the origin: simple, mostly concave, in a tilted plane.
std::vector<glm::dvec3> star(int corners, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> radius(0.1, 1.0);
  const glm::dmat3 tilt(glm::rotate(glm::dmat4(1.0), 1.1, glm::dvec3(1.0, 2.0, 3.0)));
  std::vector<glm::dvec3> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners, r = radius(generator);
    polygon.push_back(tilt * glm::dvec3(r * std::cos(angle), r * std::sin(angle), 0.0));
  }
  return polygon;
}

TEST_CASE("polygons, concave or with corners on straight edges, are tiled") {
  check_tiling({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}});
  check_tiling(
      {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  for (unsigned seed = 0; seed < 20; ++seed)
    check_tiling(star(5 + static_cast<int>(seed) * 3, seed));
  check_tiling(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
}

TEST_CASE("a dart is split along its only diagonal inside") {
  const reading::Triangulation dart = reading::triangulate_polygon(
      std::vector<glm::dvec3>{{0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0}});
  REQUIRE(dart.triangles.size() == 2);
  for (const auto& triangle : dart.triangles) {
    CHECK(std::count(triangle.begin(), triangle.end(), 0u) == 1);
    CHECK(std::count(triangle.begin(), triangle.end(), 2u) == 1);
  }
}

TEST_CASE("the triangles of a polygon depend neither on its winding nor on its first corner") {
  const std::vector<glm::dvec3> polygon = star(17, 3);
  const auto positions = [](const std::vector<glm::dvec3>& corners) {
    std::vector<std::vector<double>> result;
    for (const auto& triangle : reading::triangulate_polygon(corners).triangles) {
      std::vector<double> sorted;
      for (const std::uint32_t i : triangle) {
        sorted.insert(sorted.end(), {corners[i].x, corners[i].y, corners[i].z});
      }
      std::sort(sorted.begin(), sorted.end());
      result.push_back(sorted);
    }
    return result;
  };
  std::vector<glm::dvec3> reversed(polygon.rbegin(), polygon.rend()), rotated = polygon;
  std::rotate(rotated.begin(), rotated.begin() + 5, rotated.end());
  CHECK(positions(reversed) == positions(polygon));
  CHECK(positions(rotated) == positions(polygon));
}

TEST_CASE("a polygon that crosses itself is told from a simple one") {
  CHECK_FALSE(reading::triangulate_polygon(
                  std::vector<glm::dvec3>{{0, 0, 0}, {4, 3, 0}, {4, 0, 0}, {0, 2, 0}, {-1, 1, 0}})
                  .simple);
}

/// Next to every edge crosses thousands of others.
std::vector<glm::dvec3> random_polygon(std::size_t count) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> place(0.0, 1.0);
  std::vector<glm::dvec3> corners(count);
  for (glm::dvec3& corner : corners) corner = {place(generator), place(generator), 0.0};
  return corners;
}

TEST_CASE(
    "a polygon of 60,000 corners is triangulated in seconds, whether it crosses itself or not") {
  check_tiling(star(60'000, 1));
  // Rounds over all corners for each triangle took more than eight minutes.
  const std::vector<glm::dvec3> crossing = random_polygon(60'000);
  const std::clock_t begin = std::clock();  // of the processor, which other programs take none of
  const reading::Triangulation result = reading::triangulate_polygon(crossing);
  CHECK(std::clock() - begin < 20 * CLOCKS_PER_SEC);
  CHECK_FALSE(result.simple);
  CHECK(result.triangles.size() == crossing.size() - 2);
}

TEST_CASE("polygons without area give triangles for the caller to drop, and end") {
  CHECK(
      reading::triangulate_polygon(std::vector<glm::dvec3>(6, glm::dvec3(1.0))).triangles.size() ==
      4);
  CHECK(reading::triangulate_polygon(
            std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}})
            .triangles.size() == 2);
}

/// Asks to stop when it is asked for the n-th time.
class StopAtLook : public Progress {
 public:
  explicit StopAtLook(int look) : look_(look) {}
  bool cancelled() const override { return ++looks_ == look_; }

 private:
  int look_;
  mutable int looks_ = 0;
};

TEST_CASE("an import that is asked to stop does so within a polygon, among faces and among lines") {
  const std::vector<glm::dvec3> polygon = random_polygon(20'000);
  const int look = GENERATE(1, 2, 3, 4, 5, 6, 7, 8);
  CAPTURE(look);
  CHECK_THROWS_AS(reading::triangulate_polygon(polygon, StopAtLook(look)), Interrupted);
  // 3,000 lines are looked through, then read, then made triangles.
  const SceneFolderOnDisk folder;
  std::string faces;
  for (int i = 0; i < 3'000; ++i) faces += "f 1 2 3\n";
  folder.write("materials.mtl", lamp_and_wall);
  const std::filesystem::path file =
      folder.write("scene.obj", "mtllib materials.mtl\n" + unit_square + "usemtl lamp\n" + faces);
  CHECK_THROWS_AS(loading::load_scene(file, {}, StopAtLook(look)), Interrupted);
  CHECK_NOTHROW(loading::load_scene(file, {}, StopAtLook(look + 8)));
}

}  // namespace
}  // namespace photile::test
