// Meshes of glTF files.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

double total_area(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) area += triangle_area(scene, t);
  return area;
}

}  // namespace

TEST_CASE("node transforms apply from the root down: translation, rotation, scale") {
  nlohmann::json document = square_document();
  const double h = std::sqrt(0.5);
  document["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, h, h}}},
                       {{"name", "panel"}, {"mesh", 0}, {"scale", {2, 3, 1}}}};
  const Scene scene = load_gltf(document);
  CHECK(total_area(scene) == Approx(6.0));
  // (1,1,0) -> scaled (2,3,0) -> a quarter turn about z (-3,2,0) -> moved (7,2,0)
  bool found = false;
  for (const glm::vec3& v : scene.vertices) {
    found |= glm::length(glm::dvec3(v) - glm::dvec3(7, 2, 0)) < 1e-6;
  }
  CHECK(found);
}

TEST_CASE("--set hide leaves out nodes with all below them, and meshes, by their names") {
  nlohmann::json document = square_document();
  document["meshes"].push_back(document["meshes"][0]);
  document["meshes"][1]["name"] = "other square";
  document["nodes"].push_back({{"name", "cone of light"}, {"mesh", 0}, {"children", {2}}});
  document["nodes"].push_back({{"name", "below"}, {"mesh", 1}, {"translation", {0, 0, 3}}});
  document["nodes"][1]["translation"] = {0, 0, 1};
  document["scenes"][0]["nodes"] = {0, 1};
  const auto names = [&](const std::vector<std::string>& hidden) {
    SceneLoadOptions options;
    options.hidden = hidden;
    std::vector<std::string> found;
    for (const ImportedMesh& mesh : load_gltf(document, options).report.meshes) {
      CHECK(mesh.triangles == 2);
      found.push_back(mesh.name);
    }
    return found;
  };
  CHECK(names({}) == std::vector<std::string>{"panel", "cone of light", "below"});
  CHECK(names({"cone*"}) == std::vector<std::string>{"panel"});
  CHECK(names({"other*"}) == std::vector<std::string>{"panel", "cone of light"});
}

TEST_CASE("a mirrored node keeps the front of its triangles where the mirror puts it") {
  nlohmann::json document = square_document();
  document["nodes"][0]["scale"] = {-1, 1, 1};  // mirrors in x: the square still faces +z
  const Scene scene = load_gltf(document);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    CHECK(face_normal(scene, oriented(t, scene.front_side[t])).z == Approx(1.0));
  }
  for (const auto& normals : scene.corner_normal) CHECK(normals[0] == glm::vec3(0, 0, 1));
}

TEST_CASE("shading normals follow the inverse transpose of a node's transform") {
  nlohmann::json document = square_document();
  // Normals (0, 0.6, 0.8) by way of the buffer; scale (1, 2, 1) makes them (0, 0.3, 0.8).
  const SceneFolderOnDisk folder;
  std::string buffer = square_buffer().substr(0, 92);
  for (int i = 0; i < 4; ++i) buffer += bytes_of<float>({0.0f, 0.6f, 0.8f});
  folder.write("square.bin", buffer);
  document["nodes"][0]["scale"] = {1, 2, 1};
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0, 0.3, 0.8));
  REQUIRE(scene.corner_normal.size() == 2);
  CHECK(glm::length(glm::dvec3(scene.corner_normal[0][0]) - expected) < 1e-6);
}

TEST_CASE("strips and fans give the triangles of the specification") {
  nlohmann::json document = square_document();
  auto& primitive = document["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["mode"] = 6;  // fan over the square's corners
  const Scene fan = load_gltf(document);
  CHECK(fan.triangle_count() == 2);
  CHECK(total_area(fan) == Approx(1.0));
  for (std::uint32_t t = 0; t < 2; ++t) {
    CHECK(face_normal(fan, oriented(t, fan.front_side[t])).z == Approx(1.0));
  }
  // Indices 0 1 2 0 2 3 as a strip: (0,1,2), (1,0,2), (2,0,2), (0,3,2) by the rule for odd ones.
  primitive["indices"] = 2;
  primitive["mode"] = 5;
  const Scene strip = load_gltf(document);
  CHECK(strip.triangle_count() == 3);
  CHECK(strip.report.degenerate_triangles == 1);
  CHECK(face_normal(strip, oriented(0, strip.front_side[0])).z == Approx(1.0));
  CHECK(face_normal(strip, oriented(1, strip.front_side[1])).z == Approx(-1.0));
  CHECK(face_normal(strip, oriented(2, strip.front_side[2])).z == Approx(-1.0));
}

TEST_CASE("a sparse accessor replaces the elements that it names") {
  nlohmann::json document = square_document();
  document["buffers"].push_back({{"uri", "sparse.bin"}, {"byteLength", 16}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 4}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 4}, {"byteLength", 12}});
  document["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", 4}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", 5}}}};
  const SceneFolderOnDisk folder;
  folder.write("square.bin", square_buffer());
  folder.write("sparse.bin", bytes_of<std::uint16_t>({2, 0}) + bytes_of<float>({3, 3, 0}));
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  // Corner 2 moved from (1,1) to (3,3): shoelace area of (0,0) (1,0) (3,3) (0,1).
  CHECK(total_area(scene) == Approx(3.0));
}

TEST_CASE("quantised positions and texture coordinates are read") {
  nlohmann::json document = square_document();
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_mesh_quantization"};
  document["accessors"][0] = {{"bufferView", 0},
                              {"componentType", 5123},
                              {"normalized", true},
                              {"count", 4},
                              {"type", "VEC3"}};
  document["bufferViews"][0]["byteStride"] = 8;
  const SceneFolderOnDisk folder;
  std::string buffer = square_buffer();
  buffer.replace(
      0, 32,
      bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 65535, 65535, 0, 0, 0, 65535, 0, 0}));
  folder.write("square.bin", buffer);
  CHECK(total_area(load_scene(folder.write("scene.gltf", document.dump()))) == Approx(1.0));
}

TEST_CASE("a binary glTF file gives the same scene as its text form") {
  nlohmann::json document = square_document();
  const Scene text = load_gltf(document);
  document["buffers"][0].erase("uri");
  std::string json = document.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string data = square_buffer();
  const auto word = [](std::size_t value) {
    return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)});
  };
  const SceneFolderOnDisk folder;
  const Scene binary = load_scene(
      folder.write("scene.glb", "glTF" + word(2) + word(12 + 8 + json.size() + 8 + data.size()) +
                                    word(json.size()) + "JSON" + json + word(data.size()) +
                                    std::string("BIN\0", 4) + data));
  CHECK(binary.vertices == text.vertices);
  CHECK(binary.triangles == text.triangles);
  CHECK(binary.front_side == text.front_side);
}

TEST_CASE("a node of two parents appears twice, and each appearance is a light of its own") {
  nlohmann::json document = square_document();
  document["nodes"] = {{{"children", {2}}},
                       {{"children", {2}}, {"translation", {0, 0, 1}}},
                       {{"name", "panel"}, {"mesh", 0}}};
  document["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = load_gltf(document);
  CHECK(scene.triangle_count() == 4);
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].name == "panel");
  CHECK(scene.lights[1].name == "panel_2");
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

TEST_CASE("buffers have names of any kind, and lie outside the scene's folder where allowed") {
  const SceneFolderOnDisk folder;
  folder.write("outside.bin", square_buffer());
  folder.write("inner/sub/A..B.bin", square_buffer());
  std::filesystem::create_symlink("../outside.bin", folder.path / "inner/link.bin");
  for (const char* uri : {"sub/A..B.bin", "../outside.bin", "link.bin"}) {
    json document = square_document();
    document["buffers"][0]["uri"] = uri;
    SceneLoadOptions options;
    options.allow_outside = std::string(uri) != "sub/A..B.bin";
    CHECK(load_scene(folder.write("inner/scene.gltf", document.dump()), options).triangle_count() ==
          2);
  }
}

}  // namespace photile::test
