// Files as users meet them: incomplete, redundant, compressed, or from exporters with habits.
#include <numbers>

#include "scene_files.hpp"
#include "scene_invariants.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

const std::string three_materials =
    "newmtl lamp\nKe 2 2 2\nnewmtl wall\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.1 0.2 0.3\n";

/// A unit square at z = 1 that shines.
const std::string lamp_above =
    "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\no lamp\nusemtl lamp\nf 5 6 7 8\n";

}  // namespace

TEST_CASE("a face that the file has twice is one, whatever its winding") {
  const std::string repeat = GENERATE("f 1 2 3 4\n", "f 4 3 2 1\n", "f 2 3 4 1\n");
  const Scene scene = load_obj(
      unit_square + lamp_above + "o floor\nusemtl wall\nf 1 2 3 4\n" + repeat, three_materials);
  check_invariants(scene);
  // A quad from another corner may be cut along its other diagonal, but not here: the
  // triangulation of a polygon depends neither on its winding nor on its first corner.
  CHECK(scene.triangle_count() == 4);
  CHECK(scene.report.duplicate_triangles == 2);
  CHECK(warns(scene, {"2 triangles that coincide with others"}));
}

TEST_CASE("two materials in one place that face away from each other are two sides") {
  // The third and the fourth face look where others look that come before them.
  const Scene scene = load_obj(unit_square + lamp_above +
                                   "usemtl other\nf 1 2 3\nusemtl wall\nf 3 2 1\nf 1 2 3\n"
                                   "usemtl other\nf 1 3 2\n",
                               three_materials);
  REQUIRE(scene.triangle_count() == 4);
  CHECK(scene.report.duplicate_triangles == 2);
  CHECK(scene.triangles[2] == scene.triangles[3]);
  CHECK(scene.front_side[2] != scene.front_side[3]);
  CHECK(scene.materials[scene.triangle_material[2]].name == "other");
  CHECK(scene.materials[scene.triangle_material[3]].name == "wall");
  const Scene alike =
      load_obj(unit_square + lamp_above + "usemtl other\nf 1 2 3\nf 3 2 1\nusemtl wall\nf 3 2 1\n",
               three_materials);
  CHECK(alike.triangle_count() == 3);
  CHECK(alike.report.duplicate_triangles == 2);
}

TEST_CASE("a lamp of two faces back to back shines from both, a repeated face not twice") {
  const double luminance = 2.0;
  const Scene both =
      load_obj(unit_square + "o lamp\nusemtl lamp\nf 1 2 3 4\nf 4 3 2 1\n", three_materials);
  CHECK(both.triangle_count() == 4);
  CHECK(both.lights.at(0).power == Approx(2 * pi * luminance));
  const Scene repeated =
      load_obj(unit_square + "o lamp\nusemtl lamp\nf 1 2 3 4\nf 2 3 4 1\n", three_materials);
  CHECK(repeated.triangle_count() == 2);
  CHECK(repeated.lights.at(0).power == Approx(pi * luminance));
}

TEST_CASE("a node that an exporter wrote twice is one surface") {
  json document = square_document();
  document["nodes"].push_back({{"name", "copy"}, {"mesh", 1}});
  document["nodes"].push_back({{"name", "copy again"}, {"mesh", 1}});
  document["nodes"][1]["translation"] = document["nodes"][2]["translation"] = {0, 0, -1};
  document["scenes"][0]["nodes"] = {0, 1, 2};
  document["meshes"].push_back(document["meshes"][0]);
  document["meshes"][1]["primitives"][0]["material"] = 1;
  document["materials"].push_back({{"name", "wall"}});
  const Scene scene = load_gltf(document);
  check_invariants(scene);
  CHECK(scene.triangle_count() == 4);
  CHECK(scene.report.duplicate_triangles == 2);
}

TEST_CASE("edges of any number of faces are kept as they are") {
  // Three quads at one edge, and two triangles that meet in one corner.
  const Scene scene = load_obj(
      "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv -1 1 0\nv -1 1 1\nv -1 -1 0\nv -1 -1 1\nv 2 1 0\n"
      "v 2 -1 0\nusemtl lamp\nf 1 2 4 3\nf 1 2 6 5\nf 1 2 8 7\nf 3 9 10\n",
      three_materials);
  check_invariants(scene);
  CHECK(scene.triangle_count() == 7);
  CHECK(scene.report.warnings.empty());
}

TEST_CASE("absent, zero and inverted normals leave the surface as its corners say") {
  const std::string shiny = "newmtl lamp\nKe 2 2 2\nKd 0.2 0.2 0.2\nKs 0.5 0.5 0.5\nillum 2\n";
  const Scene absent = load_obj(unit_square + "usemtl lamp\nf 1 2 3\n", shiny);
  CHECK(absent.corner_normal.empty());
  const Scene zero = load_obj(unit_square + "vn 0 0 0\nusemtl lamp\nf 1//1 2//1 3//1\n", shiny);
  CHECK(zero.corner_normal.empty());
  const Scene inverted =
      load_obj(unit_square + "vn 0 0 -1\nusemtl lamp\nf 1//1 2//1 3//1\n", shiny);
  REQUIRE(inverted.corner_normal.size() == 1);
  for (const glm::vec3& normal : inverted.corner_normal[0]) CHECK(normal == glm::vec3(0, 0, 1));
  for (const Scene* scene : {&absent, &zero, &inverted}) {
    CHECK(front_of(*scene, 0).z == Approx(1.0));
  }
  json document = square_document();
  document["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  CHECK(load_gltf(document).corner_normal.empty());
}

TEST_CASE("ends of lines, byte-order marks, tabs and leading blanks change nothing") {
  const SceneFolderOnDisk folder;
  folder.write("my lamps.mtl", "\xEF\xBB\xBFnewmtl lamp\r\n\tKe 2 2 2\r\n");
  const Scene scene = load_scene(
      folder.write("scene.obj",
                   "\xEF\xBB\xBFmtllib my lamps.mtl\r\n  v 0 0 0\r\nv\t1 0 0\r\nv 1 1 0 \r\n"
                   "usemtl lamp\r\n\tf 1 2 3"));
  CHECK(scene.triangle_count() == 1);
  CHECK(scene.lights.at(0).power == Approx(pi * 0.5 * 2.0));
  CHECK(scene.report.warnings.empty());
}

TEST_CASE("material libraries are found as exporters name them") {
  const std::string lamp = "newmtl lamp\nKe 2 2 2\n", wall = "newmtl wall\nKd 0.5 0.5 0.5\n";
  const auto load = [&](const std::string& statements) {
    const SceneFolderOnDisk folder;
    folder.write("my own lamps.mtl", lamp);
    folder.write("parts/lamps.mtl", lamp);
    folder.write("walls.mtl", wall);
    folder.write("empty.mtl", "");
    return load_scene(folder.write(
        "scene.obj",
        statements + "\n" + unit_square + "usemtl lamp\nf 1 2 3\nusemtl wall\nf 1 3 4\n"));
  };
  for (const std::string statements :
       {"mtllib my own lamps.mtl\nmtllib walls.mtl", "mtllib my\\ own\\ lamps.mtl walls.mtl",
        "mtllib parts\\lamps.mtl\nmtllib walls.mtl \t", "mtllib walls.mtl  ./parts/lamps.mtl",
        "mtllib empty.mtl\nmtllib walls.mtl walls.mtl\nmtllib parts/lamps.mtl"}) {
    CAPTURE(statements);
    const Scene scene = load(statements);
    CHECK(scene.lights.at(0).power == Approx(pi * 0.5 * 2.0));
    CHECK(scene.report.warnings.empty());
    CHECK(scene.materials.at(1).diffuse == glm::vec3(0.5f));
  }
  const Scene some = load("mtllib absent lamps.mtl parts/lamps.mtl");
  CHECK(warns(some, {"material library 'absent'"}));
  CHECK(warns(some, {"'wall'", "mid grey"}));
}

TEST_CASE("all perspective cameras of a glTF scene are there, in the order of its nodes") {
  json document = square_document();
  document["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 1}}}},
                         {{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 1}}}}};
  document["nodes"].push_back({{"name", "door"}, {"camera", 1}, {"translation", {0, 0, 5}}});
  document["nodes"].push_back({{"name", "window"}, {"camera", 0}, {"translation", {0, 0, 4}}});
  document["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = load_gltf(document);
  REQUIRE(scene.cameras.size() == 2);
  CHECK(scene.cameras[0].name == "door");
  CHECK(scene.cameras[0].vertical_field_of_view == Approx(0.9));
  CHECK(scene.cameras[1].name == "window");
}

}  // namespace photile::test
