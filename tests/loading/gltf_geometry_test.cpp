// Meshes of glTF files.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gltf/document.hpp"
#include "gltf/gltf_import.hpp"
#include "photile/limits.hpp"
#include "scene_files.hpp"

namespace photile::test {

using nlohmann::json;

TEST_CASE("node transforms apply from the root down: translation, rotation, scale") {
  json document = square_document();
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
  json document = square_document();
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
  json document = square_document();
  document["nodes"][0]["scale"] = {-1, 1, 1};  // mirrors in x: the square still faces +z
  const Scene scene = load_gltf(document);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    CHECK(front_of(scene, t).z == Approx(1.0));
  }
  for (const auto& normals : scene.corner_normal) CHECK(normals[0] == glm::vec3(0, 0, 1));
}

TEST_CASE("shading normals follow the inverse transpose of a node's transform") {
  json document = square_document();
  // Normals (0, 0.6, 0.8) by way of the buffer; scale (1, 2, 1) makes them (0, 0.3, 0.8).
  std::string buffer = square_buffer().substr(0, 92);
  for (int i = 0; i < 4; ++i) buffer += bytes_of<float>({0.0f, 0.6f, 0.8f});
  document["nodes"][0]["scale"] = {1, 2, 1};
  const Scene scene = load_gltf(document, {}, {{"square.bin", buffer}});
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0, 0.3, 0.8));
  REQUIRE(scene.corner_normal.size() == 2);
  CHECK(glm::length(glm::dvec3(scene.corner_normal[0][0]) - expected) < 1e-6);
}

TEST_CASE("strips and fans give the triangles of the specification") {
  json document = square_document();
  auto& primitive = document["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["mode"] = 6;  // fan over the square's corners
  const Scene fan = load_gltf(document);
  CHECK(fan.triangle_count() == 2);
  CHECK(total_area(fan) == Approx(1.0));
  for (std::uint32_t t = 0; t < 2; ++t) CHECK(front_of(fan, t).z == Approx(1.0));
  // Indices 0 1 2 0 2 3 as a strip: (0,1,2), (1,0,2), (2,0,2), (0,3,2) by the rule for odd ones.
  primitive["indices"] = 2;
  primitive["mode"] = 5;
  const Scene strip = load_gltf(document);
  CHECK(strip.triangle_count() == 3);
  CHECK(strip.report.degenerate_triangles == 1);
  CHECK(front_of(strip, 0).z == Approx(1.0));
  CHECK(front_of(strip, 1).z == Approx(-1.0));
  CHECK(front_of(strip, 2).z == Approx(-1.0));
}

TEST_CASE("a sparse accessor replaces the elements that it names, of indices, too") {
  const auto load = [](int accessor, int index_type, const std::string& replacement) {
    const std::size_t length = replacement.size();
    json document = square_document();
    document["buffers"].push_back({{"uri", "sparse.bin"}, {"byteLength", length}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 4}});
    document["bufferViews"].push_back(
        {{"buffer", 1}, {"byteOffset", 4}, {"byteLength", length - 4}});
    document["accessors"][accessor]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", 4}, {"componentType", index_type}}},
        {"values", {{"bufferView", 5}}}};
    return load_gltf(document, {}, {{"sparse.bin", replacement}});
  };
  // Corner 2 moved from (1,1) to (3,3): shoelace area of (0,0) (1,0) (3,3) (0,1).
  CHECK(total_area(load(0, 5123, bytes_of<std::uint16_t>({2, 0}) + bytes_of<float>({3, 3, 0}))) ==
        Approx(3.0));
  // Corner 4 of 0 1 2 0 2 3 becomes 1: the square of area 1 becomes two halves that overlap.
  const Scene halves = load(2, 5121, bytes_of<std::uint16_t>({4, 0, 1}));
  REQUIRE(halves.triangle_count() == 2);
  for (const glm::vec3& corner : halves.corners(1)) CHECK(corner.x + corner.y < 1.5f);
}

TEST_CASE("quantised positions and texture coordinates are read") {
  json document = square_document();
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_mesh_quantization"};
  document["accessors"][0] = {{"bufferView", 0},
                              {"componentType", 5123},
                              {"normalized", true},
                              {"count", 4},
                              {"type", "VEC3"}};
  document["bufferViews"][0]["byteStride"] = 8;
  std::string buffer = square_buffer();
  buffer.replace(
      0, 32,
      bytes_of<std::uint16_t>({0, 0, 0, 0, 65535, 0, 0, 0, 65535, 65535, 0, 0, 0, 65535, 0, 0}));
  CHECK(total_area(load_gltf(document, {}, {{"square.bin", buffer}})) == Approx(1.0));
}

TEST_CASE("a binary glTF file gives the same scene as its text form") {
  const Scene text = load_gltf(square_document());
  const SceneFolderOnDisk folder;
  const Scene binary = load_scene(folder.write("scene.glb", glb_of(square_document())));
  CHECK(binary.vertices == text.vertices);
  CHECK(binary.triangles == text.triangles);
  CHECK(binary.front_side == text.front_side);
}

TEST_CASE("a node of two parents appears twice, and each appearance is a light of its own") {
  json document = square_document();
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
  std::string buffer = square_buffer();
  const float infinity = std::numeric_limits<float>::infinity();
  std::memcpy(&buffer[3 * 12], &infinity, sizeof infinity);  // the last corner
  const Scene scene = load_gltf(square_document(), {}, {{"square.bin", buffer}});
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

// Small files that ask for more than any memory holds are refused before anything is read.

namespace {

using Catch::Contains;

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
  CHECK_THAT(error, Contains("scene.gltf") && Contains(std::to_string((many / 3) << 15)) &&
                        Contains("32768 instances of mesh 'square'") &&
                        Contains(std::to_string(limits::max_triangles)));
}

TEST_CASE("meshes are not repeated beyond the limit from files that hold few bytes") {
  json document = placed_often(4);
  make_large(document);
  CHECK_THAT(size_refusal(document),
             Contains(std::to_string(16 * (many / 3))) &&
                 Contains("at most 51") &&  // 140 bytes, 5 nodes
                 Contains("mesh 'square'") && Contains("in 16 instances"));
  document = placed_often(1);
  make_large(document);
  CHECK(2 * (many / 3) < limits::unchecked_triangles);
  CHECK(size_refusal(document).empty());
}

TEST_CASE("vertices that no triangle uses, and primitives without any, count too") {
  json document = placed_often(4);
  for (const int accessor : {0, 1, 3}) make_sparse(document["accessors"][accessor], many, 0);
  CHECK_THAT(size_refusal(document), Contains("fewer instances"));
  document = placed_often(15);
  json& primitives = document["meshes"][0]["primitives"];
  for (int i = 0; i < 1'000; ++i) primitives.push_back({{"attributes", {{"TEXCOORD_0", 1}}}});
  CHECK_THAT(size_refusal(document), Contains("fewer instances"));
}

TEST_CASE("meshes that share a buffer count each") {
  json document = square_document();
  make_large(document);
  for (int i = 1; i < 16; ++i) {
    document["meshes"].push_back(document["meshes"][0]);
    document["nodes"].push_back({{"mesh", i}});
    document["scenes"][0]["nodes"].push_back(i);
  }
  CHECK_THAT(size_refusal(document), Contains("fewer instances"));
}

TEST_CASE("counts do not wrap") {
  json document = placed_often(12);
  document["accessors"][2]["count"] = 1ull << 53;
  CHECK_THAT(size_refusal(document), Contains("triangles"));
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
  CHECK_THAT(size_refusal(document), Contains("fewer instances"));
}

// Meshes that several nodes place stay instances, beside their flattened triangles.

namespace {

constexpr int cells = 96;  // 18,432 triangles, enough to be shared by two places

/// A hilly square of cells x cells quads around (10, 0, 0), off its own origin.
std::vector<float> hill_positions() {
  std::vector<float> positions;
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      const float u = static_cast<float>(x) / cells - 0.5f;
      const float v = static_cast<float>(y) / cells - 0.5f;
      positions.insert(positions.end(), {10.0f + u, v, 0.3f * u * u - 0.2f * v * v + 0.1f * u * v});
    }
  }
  return positions;
}

std::vector<std::uint16_t> hill_indices() {
  std::vector<std::uint16_t> indices;
  const auto at = [](int x, int y) { return static_cast<std::uint16_t>(y * (cells + 1) + x); };
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      indices.insert(indices.end(), {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y),
                                     at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return indices;
}

/// Loads a glowing hill in the places of `nodes`, all of which are roots unless they are children.
Scene load_hills(const json& nodes, const std::vector<int>& roots,
                 const std::vector<std::uint16_t>& indices = hill_indices()) {
  const std::string positions = bytes_of(hill_positions());
  const std::string corners = bytes_of(indices);
  json document = square_document();
  document["nodes"] = nodes;
  document["scenes"][0]["nodes"] = roots;
  document["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}}};
  document["buffers"] = {{{"uri", "hill.bin"}, {"byteLength", positions.size() + corners.size()}}};
  document["bufferViews"] = {
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", positions.size()}},
      {{"buffer", 0}, {"byteOffset", positions.size()}, {"byteLength", corners.size()}}};
  document["accessors"] = {
      {{"bufferView", 0},
       {"componentType", 5126},
       {"count", (cells + 1) * (cells + 1)},
       {"type", "VEC3"},
       {"min", {9.5, -0.5, -1}},
       {"max", {10.5, 0.5, 1}}},
      {{"bufferView", 1}, {"componentType", 5123}, {"count", indices.size()}, {"type", "SCALAR"}}};
  return load_gltf(document, {}, {{"hill.bin", positions + corners}});
}

/// How far the corners of an instance's mesh lie from those of the scene's triangles, in metres.
double largest_distance(const Scene& scene, const MeshInstance& instance) {
  const SharedMesh& mesh = scene.shared_meshes[instance.mesh];
  double largest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const glm::vec3& corner : scene.corners(instance.first_triangle + t)) {
      double nearest = INFINITY;
      for (int c = 0; c < 3; ++c) {
        const glm::dvec4 local(glm::dvec3(mesh.vertices[mesh.triangles[t][c]]), 1.0);
        nearest = std::min(
            nearest, glm::distance(glm::dvec3(corner), glm::dmat4x3(instance.to_world) * local));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("turned, scaled, mirrored and nested places of a mesh are instances of it") {
  const double h = std::sqrt(0.5);
  const json nodes = {{{"mesh", 0}},
                      {{"mesh", 0}, {"translation", {3, 1, 2}}, {"rotation", {0, 0, h, h}}},
                      {{"mesh", 0}, {"scale", {-1, 2, 0.5}}},
                      {{"children", {4}}, {"rotation", {h, 0, 0, h}}, {"translation", {0, 5, 0}}},
                      {{"mesh", 0}, {"rotation", {0, 0.6, 0, 0.8}}, {"scale", {2, 2, 2}}}};
  const Scene scene = load_hills(nodes, {0, 1, 2, 3});
  REQUIRE(scene.triangle_count() == 4 * 2 * cells * cells);
  REQUIRE(scene.shared_meshes.size() == 1);
  CHECK(scene.shared_meshes[0].triangles.size() == 2 * cells * cells);
  REQUIRE(scene.instances.size() == 4);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    CHECK(scene.instances[i].first_triangle == i * 2 * cells * cells);
    CHECK(largest_distance(scene, scene.instances[i]) < 1e-5);
  }
}

TEST_CASE("the mesh of an instance lies around its own centre") {
  const Scene scene = load_hills({{{"mesh", 0}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}}, {0, 1});
  REQUIRE(scene.shared_meshes.size() == 1);
  for (const glm::vec3& vertex : scene.shared_meshes[0].vertices) {
    CHECK(std::abs(vertex.x) <= 0.5f);
  }
}

TEST_CASE("skewed places are no instances") {
  const json skewed = {{{"mesh", 0}},
                       {{"mesh", 0}, {"translation", {0, 3, 0}}},
                       {{"children", {3}}, {"scale", {1, 3, 1}}, {"translation", {0, 9, 0}}},
                       {{"mesh", 0}, {"rotation", {0, 0, std::sin(0.3), std::cos(0.3)}}}};
  const Scene scene = load_hills(skewed, {0, 1, 2});
  CHECK(scene.triangle_count() == 3 * 2 * cells * cells);
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.instances[1].first_triangle == 2 * cells * cells);
}

TEST_CASE("a mesh in one place, or in one that is not skewed, is not shared") {
  CHECK(load_hills({{{"mesh", 0}, {"scale", {2, 1, 1}}}}, {0}).instances.empty());
  const Scene one = load_hills({{{"mesh", 0}},
                                {{"children", {2}}, {"scale", {1, 3, 1}}},
                                {{"mesh", 0}, {"rotation", {0, 0, 0.6, 0.8}}}},
                               {0, 1});
  CHECK(one.triangle_count() == 2 * 2 * cells * cells);
  CHECK(one.instances.empty());
  CHECK(one.shared_meshes.empty());
}

TEST_CASE("a mesh of a few triangles is not shared, however many places it has") {
  json document = square_document();
  std::vector<int> roots;
  for (int i = 0; i < 8'200; ++i) {
    document["nodes"][i] = {{"mesh", 0}, {"translation", {0, 0, i}}};
    roots.push_back(i);
  }
  document["scenes"][0]["nodes"] = roots;
  CHECK(load_gltf(document).instances.empty());
}

TEST_CASE("a mesh of a thousand triangles is shared by many places, not by two") {
  std::vector<std::uint16_t> indices = hill_indices();
  indices.resize(3 * 1'000);
  json nodes;
  std::vector<int> roots;
  for (int i = 0; i < 20; ++i) {
    nodes[i] = {{"mesh", 0}, {"translation", {0, 0, i}}};
    roots.push_back(i);
  }
  CHECK(load_hills(nodes, roots, indices).instances.size() == 20);
  CHECK(load_hills(nodes, {0, 1}, indices).instances.empty());
}

TEST_CASE("triangles without area are missing from the shared mesh as from its places") {
  std::vector<std::uint16_t> indices = hill_indices();
  indices[4] = indices[3];  // the second triangle
  const Scene scene =
      load_hills({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 3, 0}}}}, {0, 1}, indices);
  CHECK(scene.report.degenerate_triangles == 2);
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.shared_meshes[0].triangles.size() == 2 * cells * cells - 1);
  for (const MeshInstance& instance : scene.instances) {
    CHECK(largest_distance(scene, instance) < 1e-5);
  }
}

TEST_CASE("a place that loses other triangles than the first stays single") {
  // 1e-30 of its size leaves the second place no areas.
  const Scene scene = load_hills({{{"mesh", 0}},
                                  {{"mesh", 0}, {"scale", {1e-30, 1e-30, 1e-30}}},
                                  {{"mesh", 0}, {"translation", {0, 3, 0}}}},
                                 {0, 1, 2});
  REQUIRE(scene.instances.size() == 2);
  CHECK(largest_distance(scene, scene.instances[1]) < 1e-5);
}

}  // namespace photile::test
