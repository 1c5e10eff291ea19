// Files as users meet them: incomplete, redundant, compressed, or from exporters with habits.
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include "photile/limits.hpp"
#include "scene/mesh_builder.hpp"
#include "scene_files.hpp"
#include "scene_invariants.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

using nlohmann::json;
using scene::Corner;
using scene::MeshBuilder;
using std::numbers::pi;
using test::load_obj;

const std::string three_materials =
    "newmtl lamp\nKe 2 2 2\nnewmtl wall\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.1 0.2 0.3\n";

/// A unit square at z = 1 that shines.
const std::string lamp_above =
    "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\no lamp\nusemtl lamp\nf 5 6 7 8\n";

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

TEST_CASE("of two materials in one place the first counts") {
  const Scene scene =
      load_obj(unit_square + lamp_above + "usemtl other\nf 1 2 3\nusemtl wall\nf 3 2 1\nf 1 3 4\n",
               three_materials);
  REQUIRE(scene.triangle_count() == 4);
  CHECK(scene.materials[scene.triangle_material[2]].name == "other");
  CHECK(scene.materials[scene.triangle_material[3]].name == "wall");
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
    CHECK(sided_normal(*scene, sided(0, scene->front_side[0])).z == Approx(1.0));
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
  document.erase("scenes");
  document.erase("scene");
  CHECK_THROWS_AS(load("0"), UsageError);
  SceneLoadOptions options;
  options.scene = "0";
  CHECK_THROWS_AS(load_obj(unit_square + "usemtl lamp\nf 1 2 3\n", three_materials, options),
                  UsageError);
}

TEST_CASE("compressed meshes and textures are refused by the extension's name, with a remedy") {
  const auto refusal = [](const std::string& extension, const json& document) {
    json compressed = document;
    compressed["extensionsUsed"] = compressed["extensionsRequired"] = {extension};
    const std::string error = input_error_of([&] { load_gltf(compressed); });
    CAPTURE(error);
    CHECK(error.find(extension) != std::string::npos);
    return error;
  };
  json draco = square_document();
  draco["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  for (json& accessor : draco["accessors"]) accessor.erase("bufferView");
  CHECK(refusal("KHR_draco_mesh_compression", draco).find("without compression") !=
        std::string::npos);
  // A buffer that only the extension fills has no data, which the parser stumbles over.
  json meshopt = square_document();
  meshopt["buffers"].push_back({{"byteLength", 140}});
  meshopt["bufferViews"][0]["buffer"] = 1;
  CHECK(refusal("EXT_meshopt_compression", meshopt).find("without compression") !=
        std::string::npos);
  CHECK(refusal("KHR_texture_basisu", square_document()).find("PNG") != std::string::npos);
}

TEST_CASE("extensions that a file can do without are named, with what is lost") {
  json document = square_document();
  document["extensionsUsed"] = {"EXT_lights_image_based", "KHR_draco_mesh_compression",
                                "FB_ngon_encoding", "VENDOR_thing"};
  document["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 1.0}, {"specularImageSize", 16}}};
  document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  const Scene scene = load_gltf(document);
  CHECK(scene.triangle_count() == 2);
  CHECK(warns(scene, {"EXT_lights_image_based", "an environment picture"}));
  CHECK(warns(scene, {"KHR_draco_mesh_compression", "without compression"}));
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

TEST_CASE("nodes that multiply are counted before they are visited") {
  json document = square_document();
  document["nodes"] = json::array();
  // 2^300 visits of one mesh; then a chain that ends in a cycle, which ends the count as well.
  for (int i = 0; i < 300; ++i) document["nodes"].push_back({{"children", {i + 1, i + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  CHECK(input_error_of([&] { load_gltf(document); }).find("several parents") != std::string::npos);
  for (int i = 0; i < 300; ++i) document["nodes"][i] = {{"children", {i + 1}}};
  document["nodes"][300] = {{"children", {10, 20, 30}}};
  CHECK(input_error_of([&] { load_gltf(document); }).find("ancestor") != std::string::npos);
}

/// Loading `content` under `name` must fail with one line that names the file and holds `words`.
void check_refused(const std::string& name, const std::string& content,
                   const std::vector<std::string>& words) {
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  const std::filesystem::path file = folder.write(name, content);
  const std::string error = input_error_of([&] { load_scene(file); });
  CAPTURE(error);
  CHECK(error.find(file.string()) != std::string::npos);
  CHECK(error.find('\n') == std::string::npos);
  for (const std::string& word : words) CHECK(error.find(word) != std::string::npos);
}

TEST_CASE("missing, empty, unknown and special files are refused by name") {
  const SceneFolderOnDisk folder;
  const auto error_for = [](const std::filesystem::path& file) {
    return input_error_of([&] { load_scene(file); });
  };
  CHECK(error_for(folder.path / "absent.obj").find("No such file") != std::string::npos);
  CHECK(error_for(folder.path / "absent.gltf").find("absent.gltf") != std::string::npos);
  check_refused("empty.obj", "", {"empty"});
  check_refused("empty.gltf", "", {"empty"});
  check_refused("scene.fbx", "x", {".fbx", ".gltf"});
  std::filesystem::create_directory(folder.path / "folder.obj");
  CHECK(error_for(folder.path / "folder.obj").find("not a regular file") != std::string::npos);
  REQUIRE(::mkfifo((folder.path / "pipe.obj").c_str(), 0600) == 0);
  CHECK(error_for(folder.path / "pipe.obj").find("not a regular file") != std::string::npos);
}

TEST_CASE("files that are no text and no JSON are refused") {
  check_refused("utf16.obj", std::string("v\0 \0", 4), {"UTF-8"});
  check_refused("random.gltf", "\x01\x02\x03 not json at all", {"malformed"});
  check_refused("array.gltf", "[1, 2, 3]", {"malformed"});
  check_refused("short.glb", "glTF\x02", {"malformed"});
  check_refused("lies.glb", std::string("glTF\2\0\0\0\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFFJSON{}", 22),
                {"malformed"});
}

TEST_CASE("deeply nested JSON is refused before the parser's stack is used") {
  std::string deep(1'000'000, '[');
  check_refused("deep.gltf", R"({"asset": {"version": "2.0"}, "extras": )" + deep,
                {"nested", std::to_string(limits::max_json_depth)});
}

TEST_CASE("scenes without triangles or lights are refused with the remedy") {
  check_refused("nothing.obj", "# nothing\n", {"no triangles"});
  check_refused("dark.obj", unit_square + "f 1 2 3\n", {"no lights", "Ke"});
  json dark = square_document();
  dark["materials"][0]["emissiveFactor"] = {0, 0, 0};
  check_refused("dark.gltf", dark.dump(), {"no lights", "emissiveFactor"});
}

TEST_CASE("OBJ faces with impossible vertex indices are refused by face and object") {
  for (const std::string face : {"f 1 2 5", "f 0 1 2", "f -5 1 2", "f a b c"}) {
    check_refused("bad.obj", unit_square + "o thing\nf 1 2 3\n" + face + "\n",
                  {"face 2", "'thing'", "4 vertices"});
  }
}

TEST_CASE("an OBJ polygon beyond the limit of corners is refused") {
  std::string face = "f";
  for (std::uint64_t i = 0; i <= limits::max_polygon_corners; ++i) face += " 1";
  check_refused("huge.obj", unit_square + face + "\n", {"65537", "65536"});
}

TEST_CASE("glTF indices, accessors and views that leave their bounds are refused") {
  const auto refused = [](const std::function<void(json&)>& change,
                          const std::vector<std::string>& words) {
    json document = square_document();
    change(document);
    check_refused("scene.gltf", document.dump(), words);
  };
  refused(
      [](json& d) {
        d["accessors"][0]["count"] = 3;
        d["accessors"][1]["count"] = 3;
        d["accessors"][3]["count"] = 3;
      },
      {"index 3 of 3"});
  refused([](json& d) { d["accessors"][0]["count"] = 5; }, {"POSITION", "beyond"});
  refused([](json& d) { d["accessors"][0]["count"] = 1ull << 53; }, {"POSITION", "beyond"});
  refused([](json& d) { d["accessors"][0]["byteOffset"] = 1ull << 53; }, {"POSITION", "beyond"});
  refused([](json& d) { d["bufferViews"][0]["byteLength"] = 200; }, {"beyond its buffer"});
  refused([](json& d) { d["bufferViews"][0]["byteOffset"] = 1ull << 53; }, {"beyond its buffer"});
  refused([](json& d) { d["bufferViews"][0]["buffer"] = 7; }, {"no buffer 7"});
  refused([](json& d) { d["accessors"][0]["bufferView"] = 9; }, {"no buffer view 9"});
  refused([](json& d) { d["accessors"][0]["type"] = "VEC2"; }, {"POSITION", "wrong type"});
  refused([](json& d) { d["accessors"][2]["componentType"] = 5126; }, {"indices"});
  refused([](json& d) { d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; },
          {"no accessor 99"});
  refused([](json& d) { d["nodes"][0]["mesh"] = 4; }, {"no mesh 4"});
  refused([](json& d) { d["scenes"][0]["nodes"] = {8}; }, {"no node 8"});
  refused([](json& d) { d["scene"] = 3; }, {"default scene is 3"});
  refused(
      [](json& d) {
        d["accessors"][3].erase("bufferView");
        d["accessors"][3]["count"] = 1'000'000'000;
      },
      {"NORMAL", "elements without data"});
  refused(
      [](json& d) {
        d["accessors"][0].erase("bufferView");
        d["accessors"][0]["count"] = 1'000'000'000;
      },
      {"no triangles", "'square'", "no positions"});
  refused([](json& d) { d["buffers"][0]["uri"] = "absent.bin"; }, {"absent.bin"});
}

TEST_CASE("a directional light whose flux is beyond any number is refused by name") {
  json document = square_document();
  document["nodes"].push_back(
      {{"name", "star"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  document["nodes"][0]["scale"] = {1e9, 1e9, 1};
  document["scenes"][0]["nodes"] = {0, 1};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 1e300}}};
  CHECK(input_error_of([&] { load_gltf(document); }).find("'star'") != std::string::npos);
}

TEST_CASE("a glTF vertex that is not finite drops its triangles") {
  const SceneFolderOnDisk folder;
  std::string buffer = square_buffer();
  const float infinity = std::numeric_limits<float>::infinity();
  std::memcpy(&buffer[3 * 12], &infinity, sizeof infinity);  // the last corner
  folder.write("square.bin", buffer);
  const Scene scene = load_scene(folder.write("scene.gltf", square_document().dump()));
  CHECK(scene.triangle_count() == 1);
  CHECK(scene.report.non_finite_triangles == 1);
}

TEST_CASE("buffers and libraries outside the scene's folder are not read") {
  const SceneFolderOnDisk folder;
  const std::string secret = (folder.path / "outside.bin").string();
  folder.write("outside.bin", square_buffer());
  folder.write("outside.mtl", lamp_and_wall);
  std::filesystem::create_directory(folder.path / "inner");
  std::filesystem::create_symlink("../outside.bin", folder.path / "inner/link.bin");
  REQUIRE(::mkfifo((folder.path / "inner/pipe.bin").c_str(), 0600) == 0);
  const auto load_with_uri = [&](const std::string& uri, bool allow_outside) {
    json document = square_document();
    document["buffers"][0]["uri"] = uri;
    SceneLoadOptions options;
    options.allow_outside = allow_outside;
    return load_scene(folder.write("inner/scene.gltf", document.dump()), options);
  };
  for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
                                 std::string("x/../../outside.bin"), secret,
                                 std::string("link.bin"), std::string("/dev/zero")}) {
    const std::string error = input_error_of([&] { load_with_uri(uri, false); });
    CAPTURE(uri, error);
    CHECK(error.find("outside the scene's folder") != std::string::npos);
  }
  CHECK(input_error_of([&] { load_with_uri("pipe.bin", false); }).find("not a regular file") !=
        std::string::npos);
  CHECK(input_error_of([&] {
          load_with_uri("https://example.org/a.bin", false);
        }).find("not fetched") != std::string::npos);
  CHECK(load_with_uri("../outside.bin", true).triangle_count() == 2);
  CHECK(load_with_uri("link.bin", true).triangle_count() == 2);

  folder.write("inner/lamp.mtl", lamp_and_wall);
  const Scene obj =
      load_scene(folder.write("inner/scene.obj", "mtllib ../outside.mtl\nmtllib lamp.mtl\n" +
                                                     unit_square + "usemtl lamp\nf 1 2 3 4\n"));
  CHECK(warns(obj, {"../outside.mtl", "outside the scene's folder"}));
}

TEST_CASE("names with dots inside are files like any other") {
  const SceneFolderOnDisk folder;
  folder.write("sub/A..B.bin", square_buffer());
  json document = square_document();
  document["buffers"][0]["uri"] = "sub/A..B.bin";
  CHECK(load_scene(folder.write("scene.gltf", document.dump())).triangle_count() == 2);
}

// The scenes that lie beside a checkout, where they do.

/// Whether the shared scenes are here; says so when they are not.
bool available(const std::string& name) {
  if (std::filesystem::exists(test::shared_scenes_folder() / name)) return true;
  skip("no " + name + " in " + test::shared_scenes_folder().string());
  return false;
}

TEST_CASE("the kitchen has 5 lights and all its triangles but those without area") {
  if (!available("kitchen")) return;
  for (const std::string name : {"kitchen.gltf", "kitchen-diffuse.gltf"}) {
    const Scene scene = load_scene(test::shared_scenes_folder() / "kitchen" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() + scene.report.degenerate_triangles +
              scene.report.duplicate_triangles ==
          86'032);
    // Counted by exact rational arithmetic on the file's floats: two corners in one place each.
    CHECK(scene.report.degenerate_triangles == 3'290);
    CHECK(scene.report.non_finite_triangles == 0);
    CHECK(scene.lights.size() == 5);
    CHECK(needs_of(scene).glossy == (name == "kitchen.gltf"));
  }
}

TEST_CASE("the classroom has 2 lights and all its triangles") {
  if (!available("classroom")) return;
  for (const std::string name : {"classroom.gltf", "classroom-diffuse.gltf"}) {
    const Scene scene = load_scene(test::shared_scenes_folder() / "classroom" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() + scene.report.duplicate_triangles == 111'164);
    CHECK(scene.lights.size() == 2);
  }
}

/// Scene files below the folder, as SharedScene::file has them.
std::set<std::string> files_found() {
  std::set<std::string> files;
  const std::filesystem::path folder = test::shared_scenes_folder();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".obj" || extension == ".gltf" || extension == ".glb") {
      files.insert(std::filesystem::relative(entry.path(), folder).generic_string());
    }
  }
  return files;
}

TEST_CASE("the list of shared scenes has every file that is there, and no other") {
  if (!available("odd")) return;
  std::set<std::string> listed;
  for (const test::SharedScene& scene : test::shared_scenes) listed.emplace(scene.file);
  CHECK(listed == files_found());
}

TEST_CASE("every shared scene loads, or is refused in one line that says why") {
  if (!available("odd")) return;
  for (const test::SharedScene& scene : test::shared_scenes) {
    CAPTURE(scene.file);
    const std::string error =
        input_error_of([&] { check_invariants(test::load_shared_scene(scene)); });
    CAPTURE(error);
    CHECK(error.empty() == scene.refusal.empty());
    CHECK(error.find(scene.refusal) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
    if (!error.empty()) {
      const std::string name = std::filesystem::path(scene.file).filename().string();
      CHECK(error.find(name) != std::string::npos);
    }
  }
}

/// A bumpy grid of triangles with texture coordinates; every third is wound the other way round
/// when `flipped`.
Scene grid(bool flipped) {
  std::string obj;
  constexpr int side = 9;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      obj += "v " + std::to_string(x * 0.37 - 1.1) + " " + std::to_string((x * 7 + y * 5) % 11) +
             " " + std::to_string(y * 0.41 - 0.7) + "\nvt " + std::to_string(x / 8.0) + " " +
             std::to_string(y / 8.0) + "\n";
    }
  }
  obj += "usemtl lamp\n";
  int number = 0;
  const auto face = [&](int a, int b, int c) {
    if (flipped && number++ % 3 == 0) std::swap(b, c);
    for (const int i : {a, b, c}) {
      obj += (i == a ? "f " : " ") + std::to_string(i) + "/" + std::to_string(i);
    }
    obj += "\n";
  };
  for (int y = 0; y + 1 < side; ++y) {
    for (int x = 0; x + 1 < side; ++x) {
      const int i = y * side + x + 1;
      face(i, i + 1, i + side);
      face(i + 1, i + side + 1, i + side);
    }
  }
  return load_obj(obj, "newmtl lamp\nKe 1 1 1\nKd 0.5 0.5 0.5\n");
}

TEST_CASE("another winding of some triangles changes nothing but front_side, bit for bit") {
  const Scene a = grid(false), b = grid(true);
  CHECK(a.vertices == b.vertices);
  CHECK(a.triangles == b.triangles);
  CHECK(a.triangle_material == b.triangle_material);
  CHECK(a.triangle_light == b.triangle_light);
  REQUIRE(a.front_side.size() == b.front_side.size());
  for (std::size_t i = 0; i < a.front_side.size(); ++i) {
    CHECK((a.front_side[i] != b.front_side[i]) == (i % 3 == 0));
  }
}

TEST_CASE("texture coordinates follow their corners whatever the winding") {
  const auto build = [](bool flipped) {
    Scene scene;
    MeshBuilder builder(scene, {.uv = true});
    const Corner a{{1, 0, 0}, {0.1, 0.2}, {}}, b{{0, 1, 0}, {0.3, 0.4}, {}},
        c{{0, 0, 1}, {0.5, 0.6}, {}};
    builder.add({a, flipped ? c : b, flipped ? b : c}, 0, none);
    return scene;
  };
  const Scene plain = build(false), flipped = build(true);
  CHECK(plain.corner_uv == flipped.corner_uv);
  // Lexicographic order of the positions: c, b, a.
  CHECK(plain.corner_uv[0][0] == glm::vec2(0.5f, 0.6f));
  CHECK(plain.corner_uv[0][1] == glm::vec2(0.3f, 0.4f));
  CHECK(plain.corner_uv[0][2] == glm::vec2(0.1f, 0.2f));
}

TEST_CASE("the front side is the one that the winding faces, by the cross product") {
  const std::array<glm::dvec3, 4> p{glm::dvec3(0.3, 2, 1), {-1, 0.5, 0.2}, {1, 1, -2}, {0, -1, 3}};
  for (const auto& [i, j, k] : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 2, 0},
                                std::array{3, 1, 0}, std::array{2, 3, 1}, std::array{3, 2, 0}}) {
    Scene scene;
    MeshBuilder builder(scene, {});
    const auto at = [&](int n) { return p[static_cast<std::size_t>(n)]; };
    REQUIRE(builder.add({Corner{at(i), {}, {}}, Corner{at(j), {}, {}}, Corner{at(k), {}, {}}}, 0,
                        none));
    const glm::dvec3 front = glm::cross(at(j) - at(i), at(k) - at(i));
    CHECK(glm::dot(sided_normal(scene, sided(0, scene.front_side[0])), front) > 0.0);
  }
}

TEST_CASE("shading normals lie on the front side, even when the file has them the other way") {
  Scene scene;
  MeshBuilder builder(scene, {.normals = true});
  const glm::dvec3 inwards(0, 0, -2);
  builder.add({Corner{{0, 0, 0}, {}, inwards}, Corner{{1, 0, 0}, {}, inwards},
               Corner{{0, 1, 0}, {}, glm::dvec3(std::nan(""))}},
              0, none);
  builder.finish();
  REQUIRE(scene.corner_normal.size() == 1);
  // Canonical order: (0,0,0), (0,1,0), (1,0,0); the broken normal became zero.
  CHECK(scene.corner_normal[0][0] == glm::vec3(0, 0, 1));
  CHECK(scene.corner_normal[0][1] == glm::vec3(0, 0, 0));
  CHECK(scene.corner_normal[0][2] == glm::vec3(0, 0, 1));
}

TEST_CASE("positions with equal bits are welded, and -0 is 0") {
  Scene scene;
  MeshBuilder builder(scene, {});
  builder.add({Corner{{0, 0, 0}, {}, {}}, Corner{{1, 0, 0}, {}, {}}, Corner{{0, 1, 0}, {}, {}}}, 0,
              none);
  builder.add(
      {Corner{{-0.0, -0.0, 0}, {}, {}}, Corner{{1, -0.0, 0}, {}, {}}, Corner{{0, 0, 1}, {}, {}}}, 0,
      none);
  CHECK(scene.vertices.size() == 4);
}

TEST_CASE("triangles without area and with corners that are not finite are counted and dropped") {
  Scene scene;
  MeshBuilder builder(scene, {});
  const auto add = [&](const glm::dvec3& c) {
    return builder.add({Corner{{0, 0, 0}, {}, {}}, Corner{{1, 0, 0}, {}, {}}, Corner{c, {}, {}}}, 0,
                       none);
  };
  CHECK_FALSE(add({2, 0, 0}));        // on the line
  CHECK_FALSE(add({1, 0, 0}));        // two corners in one place
  CHECK_FALSE(add({0.5, 1e-45, 0}));  // the area underflows float
  CHECK_FALSE(add({0.5, std::nan(""), 0}));
  CHECK_FALSE(add({0.5, 1e39, 0}));  // beyond float: infinite once rounded
  CHECK(add({0.5, 1e-12, 0}));       // a needle, but a triangle
  CHECK(scene.report.degenerate_triangles == 3);
  CHECK(scene.report.non_finite_triangles == 2);
  CHECK(scene.triangle_count() == 1);
  CHECK(scene.front_side.size() == 1);
  CHECK(std::isfinite(sided_normal(scene, sided(0, 1)).y));
}

TEST_CASE("area and normal of a triangle are those of its closed form") {
  Scene scene;
  MeshBuilder builder(scene, {});
  builder.add({Corner{{0, 0, 0}, {}, {}}, Corner{{3, 0, 0}, {}, {}}, Corner{{0, 4, 0}, {}, {}}}, 0,
              none);
  CHECK(triangle_area(scene, 0) == Approx(6.0));
  CHECK(sided_normal(scene, sided(0, 0)) == -sided_normal(scene, sided(0, 1)));
  CHECK(std::abs(sided_normal(scene, 0).z) == Approx(1.0));
}

TEST_CASE("the bounding sphere goes through the corners of the bounding box") {
  Scene scene;
  scene.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {1, 1, 4}};
  CHECK(bounding_sphere(scene).center == glm::dvec3(1, 2, 2));
  CHECK(bounding_sphere(scene).radius == Approx(3.0));
}

}  // namespace
}  // namespace photile::test
