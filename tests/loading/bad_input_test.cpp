// Scene files that are refused, each in one line that names the file.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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

}  // namespace

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

}  // namespace photile::test
