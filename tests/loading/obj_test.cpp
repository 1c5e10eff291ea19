#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "scene_files.hpp"

namespace photile::test {
namespace {

TEST_CASE("an OBJ square becomes two triangles of area 1 that face its winding's side") {
  const Scene scene = load_obj(unit_square + "o panel\nusemtl lamp\nf 1 2 3 4\n", lamp_and_wall);
  REQUIRE(scene.triangle_count() == 2);
  CHECK(scene.report.polygons_triangulated == 1);
  CHECK(triangle_area(scene, 0) + triangle_area(scene, 1) == Approx(1.0));
  for (std::uint32_t t = 0; t < 2; ++t) {
    CHECK(sided_normal(scene, sided(t, scene.front_side[t])).z == Approx(1.0));
  }
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

TEST_CASE("an OBJ coordinate that is no number drops its triangles, counted and reported") {
  const Scene scene =
      load_obj(unit_square +
                   "v nan 0 0\nv inf 1 0\nv 1e39 2 0\nusemtl lamp\nf 1 2 3\nf 1 2 5\nf 2 3 6\n"
                   "f 3 4 7\nf 1 2 3 5\n",
               lamp_and_wall);
  CHECK(scene.triangle_count() == 1);
  CHECK(scene.report.non_finite_triangles == 5);  // the quad would have given two
  CHECK(warns(scene, {"5", "NaN"}));
}

TEST_CASE("degenerate OBJ triangles are dropped, counted and reported in one line") {
  const Scene scene =
      load_obj(unit_square + "usemtl lamp\nf 1 2 3\nf 1 1 2\nf 4 4 4\n", lamp_and_wall);
  CHECK(scene.triangle_count() == 1);
  CHECK(scene.report.degenerate_triangles == 2);
  CHECK(warns(scene, {"2 triangles without area"}));
}

TEST_CASE("a concave OBJ polygon keeps its area, against the shoelace value") {
  const Scene scene = load_obj(
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nusemtl lamp\nf 1 2 3 4 5\n", lamp_and_wall);
  REQUIRE(scene.triangle_count() == 3);
  const double area = triangle_area(scene, 0) + triangle_area(scene, 1) + triangle_area(scene, 2);
  CHECK(area == Approx(2.5));
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

TEST_CASE("what an OBJ holds beyond surfaces is named in a warning") {
  const Scene scene = load_obj(
      unit_square + "v 0 0 9 1 0 0\nl 1 2\np 1\ncurv 0 1\nusemtl lamp\nf 1 2 3 4\n", lamp_and_wall);
  CHECK(warns(scene, {"'l'"}));
  CHECK(warns(scene, {"'p'"}));
  CHECK(warns(scene, {"'curv'"}));
  CHECK(warns(scene, {"vertex colours"}));
}

TEST_CASE("a missing material library and a missing material are named and become mid grey") {
  const SceneFolderOnDisk folder;
  folder.write("lamp.mtl", lamp_and_wall);
  const Scene scene =
      load_scene(folder.write("scene.obj", "mtllib absent.mtl\nmtllib lamp.mtl\n" + unit_square +
                                               "usemtl lamp\nf 1 2 3\nusemtl nowhere\nf 1 3 4\n"));
  CHECK(warns(scene, {"absent.mtl"}));
  CHECK(warns(scene, {"'nowhere'", "grey"}));
  CHECK(scene.materials[scene.triangle_material[1]].diffuse == glm::vec3(0.5f));
}

}  // namespace
}  // namespace photile::test
