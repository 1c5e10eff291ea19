// Small glTF files that ask for more than any memory holds are refused before anything is read.
#include <catch2/catch.hpp>

#include "gltf/document.hpp"
#include "gltf/gltf_import.hpp"
#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;

constexpr std::uint64_t many = limits::max_implicit_elements;

/// The square's mesh at 2^levels places, by nodes that have each child twice.
json placed_often(int levels) {
  json document = square_document();
  document["nodes"] = json::array();
  for (int i = 0; i < levels; ++i) document["nodes"].push_back({{"children", {i + 1, i + 1}}});
  document["nodes"].push_back({{"mesh", 0}});
  return document;
}

/// An accessor of so many elements of which the file holds one.
void make_sparse(json& accessor, std::uint64_t count, int values) {
  accessor.erase("bufferView");
  accessor["count"] = count;
  accessor["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
}

/// Makes the square's mesh one of many / 3 triangles, nearly all of which have no area.
void make_large(json& document) {
  document["meshes"][0]["primitives"][0].erase("indices");
  make_sparse(document["accessors"][0], many, 0);
}

/// What the check says, without loading the scene: it may be too large for this machine.
std::string size_refusal(const json& document) {
  const SceneFolderOnDisk on_disk;
  on_disk.write("square.bin", square_buffer());
  const std::filesystem::path file = on_disk.write("scene.gltf", document.dump());
  Scene scene;
  const SceneLoadOptions options;
  files::SceneFolder folder(file, false);
  files::Warnings warnings;
  reading::AreaLights area_lights(scene);
  reading::ImportContext context{scene, folder, options, warnings, area_lights, {}};
  const tinygltf::Model model = gltf::read_gltf(context);
  const gltf::AccessorReader accessors(model, context);
  const auto visits = gltf::visit_nodes(model, context);
  return input_error_of([&] { gltf::check_scene_size(model, accessors, visits, context); });
}

}  // namespace

TEST_CASE("a file of a kilobyte that asks for a hundred gigabytes is refused") {
  json document = placed_often(15);
  make_large(document);
  CHECK(document.dump().size() < 4'000);
  // 1.1e10 triangles: 131 GB for their indices alone.
  const std::string error = input_error_of([&] { load_gltf(document); });
  CHECK_THAT(error, Catch::Contains("scene.gltf") &&
                        Catch::Contains(std::to_string((many / 3) << 15)) &&
                        Catch::Contains("32768 instances of mesh 'square'") &&
                        Catch::Contains(std::to_string(limits::max_triangles)));
}

TEST_CASE("meshes are not repeated beyond the limit from files that hold few bytes") {
  json document = placed_often(4);
  make_large(document);
  CHECK_THAT(size_refusal(document),
             Catch::Contains(std::to_string(16 * (many / 3))) &&
                 Catch::Contains("at most 51") &&  // 140 bytes, 5 nodes
                 Catch::Contains("mesh 'square'") && Catch::Contains("in 16 instances"));
  document = placed_often(1);
  make_large(document);
  CHECK(2 * (many / 3) < limits::unchecked_triangles);
  CHECK(size_refusal(document).empty());
}

TEST_CASE("vertices that no triangle uses, and primitives without any, count too") {
  json document = placed_often(4);
  for (const int accessor : {0, 1, 3}) make_sparse(document["accessors"][accessor], many, 0);
  CHECK_THAT(size_refusal(document), Catch::Contains("fewer instances"));
  document = placed_often(15);
  json& primitives = document["meshes"][0]["primitives"];
  for (int i = 0; i < 1'000; ++i) primitives.push_back({{"attributes", {{"TEXCOORD_0", 1}}}});
  CHECK_THAT(size_refusal(document), Catch::Contains("fewer instances"));
}

TEST_CASE("meshes that share a buffer count each") {
  json document = square_document();
  make_large(document);
  for (int i = 1; i < 16; ++i) {
    document["meshes"].push_back(document["meshes"][0]);
    document["nodes"].push_back({{"mesh", i}});
    document["scenes"][0]["nodes"].push_back(i);
  }
  CHECK_THAT(size_refusal(document), Catch::Contains("fewer instances"));
}

TEST_CASE("counts do not wrap") {
  json document = placed_often(12);
  document["accessors"][2]["count"] = 1ull << 53;
  CHECK_THAT(size_refusal(document), Catch::Contains("triangles"));
}

TEST_CASE("a large file may place each triangle that it holds a thousand times") {
  json document = square_document();
  const std::uint64_t held = 140 / 3 + 1'200;  // bytes and nodes
  for (int i = 1; i < 1'200; ++i) document["nodes"].push_back(json::object());
  const std::uint64_t most = held * limits::max_triangle_expansion;
  CHECK(most > limits::unchecked_triangles);
  document["accessors"][2]["count"] = 3 * most;  // the reader would not believe it
  CHECK(size_refusal(document).empty());
  document["accessors"][2]["count"] = 3 * most + 3;
  CHECK_THAT(size_refusal(document), Catch::Contains("fewer instances"));
}

}  // namespace photile::test
