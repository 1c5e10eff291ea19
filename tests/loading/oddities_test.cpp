// Files as users meet them: incomplete, redundant, compressed, or from exporters with habits.
#include <catch2/catch.hpp>
#include <numbers>

#include "scene_files.hpp"
#include "scene_invariants.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using std::numbers::pi;
using test::load_obj;

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
  CHECK(warns(scene, {"2 triangles that lie exactly on others"}));
}

TEST_CASE("of two materials in one place that face one way the first counts") {
  const Scene scene =
      load_obj(unit_square + lamp_above + "usemtl other\nf 1 2 3\nusemtl wall\nf 2 3 1\nf 1 3 4\n",
               three_materials);
  REQUIRE(scene.triangle_count() == 4);
  CHECK(scene.materials[scene.triangle_material[2]].name == "other");
  CHECK(scene.materials[scene.triangle_material[3]].name == "wall");
  CHECK(scene.report.duplicate_triangles == 1);
  CHECK(warns(scene, {"1 triangles that lie exactly on others", "that face one way the first"}));
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
    CHECK(face_normal(*scene, oriented(0, scene->front_side[0])).z == Approx(1.0));
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

TEST_CASE("textures outside the scene's folder are not read, nor names with schemes or NUL bytes") {
  const SceneFolderOnDisk folder;
  folder.write("outside.png", "no picture, but nobody may know");
  folder.write("inner/square.bin", square_buffer());
  std::filesystem::create_symlink("../outside.png", folder.path / "inner/link.png");
  const auto warning_for = [&](const std::string& uri) {
    json document = square_document();
    document["images"] = {{{"uri", uri}}};
    document["textures"] = {{{"source", 0}}};
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    const Scene scene = load_scene(folder.write("inner/scene.gltf", document.dump()));
    check_invariants(scene);
    REQUIRE(scene.report.warnings.size() == 1);
    CHECK(scene.materials[0].diffuse == glm::vec3(0.5f));
    return scene.report.warnings[0];
  };
  using Catch::Contains;
  for (const std::string uri : {"../outside.png", "%2e%2e/outside.png", "link.png", "/etc/hostname",
                                "absent/../../outside.png"}) {
    CHECK_THAT(warning_for(uri), Contains("'glow'") && Contains("outside the scene's folder"));
  }
  CHECK_THAT(warning_for("a%00b.png"), Contains("NUL byte"));
  CHECK_THAT(warning_for("https://example.org/a.png"), Contains("not fetched"));
  // What a shell would expand or run are names of files like any other.
  for (const std::string uri :
       {"$HOME/a.png", "`id`.png", "~/a.png", "$(id).png", "file:a.png", "C:\\a.png", "*.png"}) {
    CHECK_THAT(warning_for(uri), Contains("No such file"));
  }
  folder.write("inner/lamp.mtl", "newmtl lamp\nKe 2 2 2\nKd 1 1 1\nmap_Kd ..\\outside.png\n");
  const Scene obj = load_scene(folder.write(
      "inner/scene.obj", "mtllib lamp.mtl\n" + unit_square + "usemtl lamp\nf 1 2 3 4\n"));
  CHECK(warns(obj, {"'lamp'", "outside the scene's folder", "mid grey"}));
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

TEST_CASE("a scene of several is taken by name or index") {
  json document = square_document();
  document["nodes"].push_back({{"name", "far"}, {"mesh", 0}, {"translation", {0, 0, 9}}});
  document["scenes"] = {{{"name", "day"}, {"nodes", {0}}},
                        {{"name", "1"}, {"nodes", {1}}},
                        {{"name", "night"}, {"nodes", {0, 1}}}};
  const auto load = [&](const std::string& scene) {
    SceneLoadOptions options;
    options.scene = scene;
    return load_gltf(document, options);
  };
  CHECK(load("").triangle_count() == 2);
  CHECK(warns(load(""), {"of 3 scenes", "can be chosen", "0 'day', 1 '1', 2 'night'"}));
  CHECK(load("night").triangle_count() == 4);
  CHECK(load("night").report.warnings.empty());
  CHECK(load("2").triangle_count() == 4);
  CHECK(load("1").vertices[0].z == 9.0f);  // a name comes before an index
  CHECK(load("0").vertices[0].z == 0.0f);
  CHECK_THROWS_WITH(load("dusk"), Catch::Contains("'dusk'") && Catch::Contains("2 'night'"));
  CHECK_THROWS_AS(load("3"), UsageError);
  document["scene"] = 1;
  CHECK(load("").vertices[0].z == 9.0f);
  document.erase("scenes");
  document.erase("scene");
  CHECK_THROWS_AS(load("0"), UsageError);
  SceneLoadOptions options;
  options.scene = "0";
  CHECK_THROWS_AS(load_obj(unit_square + "usemtl lamp\nf 1 2 3\n", three_materials, options),
                  UsageError);
}

TEST_CASE("compressed textures are refused by the extension's name, with a remedy") {
  json compressed = square_document();
  compressed["extensionsUsed"] = compressed["extensionsRequired"] = {"KHR_texture_basisu"};
  const std::string error = input_error_of([&] { load_gltf(compressed); });
  CHECK_THAT(error, Catch::Contains("KHR_texture_basisu") && Catch::Contains("PNG"));
}

TEST_CASE("extensions that a file can do without are named, with what is lost") {
  json document = square_document();
  document["extensionsUsed"] = {"EXT_lights_image_based", "KHR_texture_basisu", "FB_ngon_encoding",
                                "VENDOR_thing"};
  document["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 1.0}, {"specularImageSize", 16}}};
  document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  const Scene scene = load_gltf(document);
  CHECK(scene.triangle_count() == 2);
  CHECK(warns(scene, {"EXT_lights_image_based", "an environment picture"}));
  CHECK(warns(scene, {"KHR_texture_basisu", "as PNG or JPEG"}));
  CHECK(warns(scene, {"VENDOR_thing", "ignored"}));
  CHECK_FALSE(warns(scene, {"FB_ngon_encoding"}));
}

TEST_CASE("indices may be sparse, too") {
  json document = square_document();
  document["buffers"].push_back({{"uri", "sparse.bin"}, {"byteLength", 6}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 2}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 4}, {"byteLength", 2}});
  document["accessors"][2]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 4}, {"componentType", 5121}}},
                                        {"values", {{"bufferView", 5}}}};
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  // Corner 4 of 0 1 2 0 2 3 becomes 1: the square of area 1 becomes two halves that overlap.
  folder.write("sparse.bin", bytes_of<std::uint16_t>({4, 0, 1}));
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  REQUIRE(scene.triangle_count() == 2);
  for (const glm::vec3& corner : scene.corners(1)) CHECK(corner.x + corner.y < 1.5f);
}

TEST_CASE("sparse accessors are bounded: their count, their indices, their values") {
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  folder.write("sparse.bin", bytes_of<std::uint16_t>({2, 0}) + bytes_of<float>({3, 3, 0}));
  const auto error_of = [&](const json& change) {
    json document = square_document();
    document["buffers"].push_back({{"uri", "sparse.bin"}, {"byteLength", 16}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 4}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 4}, {"byteLength", 12}});
    document["accessors"][0]["sparse"] = {{"count", 1},
                                          {"indices", {{"bufferView", 4}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", 5}}}};
    document["accessors"][0]["sparse"].merge_patch(change);
    return input_error_of([&] { load_scene(folder.write("scene.gltf", document.dump())); });
  };
  CHECK(error_of(json::object()).empty());
  using Catch::Contains;
  CHECK_THAT(error_of({{"count", 5}}), Contains("POSITION") && Contains("sparse"));
  CHECK_THAT(error_of({{"count", 3}}), Contains("POSITION") && Contains("beyond"));
  CHECK_THAT(error_of({{"indices", {{"componentType", 5126}}}}), Contains("sparse"));
  CHECK_THAT(error_of({{"indices", {{"byteOffset", 4}}}}), Contains("beyond"));
  CHECK_THAT(error_of({{"indices", {{"bufferView", 77}}}}), Contains("no buffer view 77"));
  CHECK_THAT(error_of({{"values", {{"byteOffset", 4}}}}), Contains("beyond"));
  CHECK_THAT(error_of({{"values", {{"bufferView", -3}}}}), Contains("values.bufferView is -3"));
}

}  // namespace photile::test
