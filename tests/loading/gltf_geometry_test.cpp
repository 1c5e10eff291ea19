// Meshes of glTF files: geometry, instances, tangents.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "photile/limits.hpp"
#include "scene_files.hpp"
#include "scene_invariants.hpp"
#include "textured_square.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

double total_area(const Scene& scene) {
  double area = 0.0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) area += triangle_area(scene, t);
  return area;
}

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

TEST_CASE("a mirrored node keeps the front of its triangles where the mirror puts it") {
  nlohmann::json document = square_document();
  document["nodes"][0]["scale"] = {-1, 1, 1};  // mirrors in x: the square still faces +z
  const Scene scene = load_gltf(document);
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    CHECK(sided_normal(scene, sided(t, scene.front_side[t])).z == Approx(1.0));
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
    CHECK(sided_normal(fan, sided(t, fan.front_side[t])).z == Approx(1.0));
  }
  // Indices 0 1 2 0 2 3 as a strip: (0,1,2), (1,0,2), (2,0,2), (0,3,2) by the rule for odd ones.
  primitive["indices"] = 2;
  primitive["mode"] = 5;
  const Scene strip = load_gltf(document);
  CHECK(strip.triangle_count() == 3);
  CHECK(strip.report.degenerate_triangles == 1);
  CHECK(sided_normal(strip, sided(0, strip.front_side[0])).z == Approx(1.0));
  CHECK(sided_normal(strip, sided(1, strip.front_side[1])).z == Approx(-1.0));
  CHECK(sided_normal(strip, sided(2, strip.front_side[2])).z == Approx(-1.0));
}

TEST_CASE("points and lines, morph targets, skins and vertex colours are named and left out") {
  nlohmann::json document = square_document();
  auto& primitives = document["meshes"][0]["primitives"];
  nlohmann::json lines = primitives[0];
  lines["mode"] = 1;
  primitives[0]["targets"] = {{{"POSITION", 0}}};
  primitives[0]["attributes"]["COLOR_0"] = 0;
  primitives.push_back(lines);
  document["skins"] = {{{"joints", {0}}}};
  document["nodes"][0]["skin"] = 0;
  const Scene scene = load_gltf(document);
  CHECK(scene.triangle_count() == 2);
  CHECK(warns(scene, {"'square'", "points and lines"}));
  CHECK(warns(scene, {"'square'", "morph targets"}));
  CHECK(warns(scene, {"'square'", "vertex colours"}));
  CHECK(warns(scene, {"'panel'", "skin"}));
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
  // An index beyond the accessor is refused.
  folder.write("sparse.bin", bytes_of<std::uint16_t>({4, 0}) + bytes_of<float>({3, 3, 0}));
  CHECK(input_error_of([&] { load_scene(folder.path / "scene.gltf"); }).find("sparse index 4") !=
        std::string::npos);
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

TEST_CASE("of several scenes the default one is loaded, with a warning") {
  nlohmann::json document = square_document();
  document["nodes"].push_back({{"name", "far"}, {"mesh", 0}, {"translation", {0, 0, 9}}});
  document["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  document["scene"] = 1;
  const Scene scene = load_gltf(document);
  CHECK(scene.triangle_count() == 2);
  CHECK(scene.vertices[0].z == 9.0f);
  CHECK(warns(scene, {"2 scenes"}));
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

TEST_CASE("cycles, deep trees and multiplying nodes are refused with the reason") {
  nlohmann::json cycle = square_document();
  cycle["nodes"] = {{{"name", "a"}, {"children", {1}}}, {{"name", "b"}, {"children", {0}}}};
  CHECK(input_error_of([&] { load_gltf(cycle); }).find("ancestor") != std::string::npos);

  nlohmann::json deep = square_document();
  deep["nodes"] = nlohmann::json::array();
  for (int i = 0; i < limits::max_node_depth; ++i) deep["nodes"].push_back({{"children", {i + 1}}});
  deep["nodes"].push_back({{"mesh", 0}});
  CHECK(input_error_of([&] { load_gltf(deep); }).find("levels deep") != std::string::npos);

  nlohmann::json many = square_document();
  many["nodes"] = nlohmann::json::array();
  for (int i = 0; i < 64; ++i) many["nodes"].push_back({{"children", {i + 1, i + 1}}});
  many["nodes"].push_back({{"mesh", 0}});
  CHECK(input_error_of([&] { load_gltf(many); }).find("several parents") != std::string::npos);
}

// Meshes that several nodes place stay instances, beside their flattened triangles.

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
  const SceneFolderOnDisk folder;
  folder.write("hill.bin", positions + corners);
  return load_scene(folder.write("scene.gltf", document.dump()));
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

// TANGENT of glTF meshes: which way normal maps turn the normals where the file says it.

using Texel = std::vector<std::uint8_t>;

const Texel red_slope{204, 128, 230}, green_slope{128, 204, 230};

/// The square (facing +z, its u along +x and v along -y) under a normal map of one texel and a
/// lamp. `tangent` is that of all corners; none where it is zero.
Scene with_tangents(
    const Texel& texel, const glm::vec4& tangent, const json& node = json::object(),
    const std::function<void(json& attributes)>& change = [](json&) {}) {
  const SceneFolderOnDisk folder;
  write_texel(folder.path / "normal.png", texel);
  std::string buffer = square_buffer();
  json document = square_document();
  document["buffers"][0]["byteLength"] = buffer.size() + 64;
  document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 64}});
  document["accessors"].push_back(
      {{"bufferView", 4}, {"componentType", 5126}, {"count", 4}, {"type", "VEC4"}});
  for (int corner = 0; corner < 4; ++corner) {
    buffer += bytes_of<float>({tangent.x, tangent.y, tangent.z, tangent.w});
  }
  folder.write("square.bin", buffer);
  document["images"] = {{{"uri", "normal.png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["normalTexture"] = {{"index", 0}};
  document["nodes"][0].update(node);
  json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
  attributes["TANGENT"] = 4;
  change(attributes);
  const Scene scene = load_scene(folder.write("scene.gltf", document.dump()));
  check_invariants(scene);
  return scene;
}

/// The mapped normal of both triangles as seen along `direction`.
glm::dvec3 mapped(const Scene& scene, const glm::vec3& direction = {0, 0, -1}) {
  std::array<glm::vec3, 2> normals;
  for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
    const auto point = trace::surface_hit(scene, {triangle, 0.3f, 0.3f}, direction);
    normals[triangle] = trace::shading_normals(scene, point, direction).mapped;
  }
  CHECK(glm::distance(normals[0], normals[1]) < 1e-5f);
  return glm::dvec3(normals[0]);
}

/// A normal of the slope of both texels along `along`, on the +z side.
glm::dvec3 sloping(const glm::dvec3& along) {
  const double slope = (204 / 127.5 - 1) / (230 / 127.5 - 1);
  return glm::normalize(slope * along + glm::dvec3(0, 0, 1));
}

/// What a byte resolves: 128 is not quite the middle.
constexpr double resolution = 0.006;

TEST_CASE("the red of a normal map runs along TANGENT, green along w times normal x tangent") {
  const glm::vec4 along_y(0, 1, 0, 1), left_handed(0, 1, 0, -1);  // 90 degrees from u
  CHECK(glm::distance(mapped(with_tangents(red_slope, along_y)), sloping({0, 1, 0})) < resolution);
  CHECK(glm::distance(mapped(with_tangents(green_slope, along_y)), sloping({-1, 0, 0})) <
        resolution);
  CHECK(glm::distance(mapped(with_tangents(red_slope, left_handed)), sloping({0, 1, 0})) <
        resolution);
  CHECK(glm::distance(mapped(with_tangents(green_slope, left_handed)), sloping({1, 0, 0})) <
        resolution);
}

TEST_CASE("tangents along the texture's coordinates give what the coordinates give") {
  for (const Texel& texel : {red_slope, green_slope}) {
    const Scene given = with_tangents(texel, {1, 0, 0, 1});
    const Scene derived = with_tangents(texel, {1, 0, 0, 1}, json::object(),
                                        [](json& attributes) { attributes.erase("TANGENT"); });
    CHECK(given.corner_tangent.size() == 2);
    CHECK(derived.corner_tangent.empty());
    CHECK(glm::distance(mapped(given), mapped(derived)) < 1e-6);
  }
}

TEST_CASE("a node that mirrors, scales or turns takes the frame of TANGENT along") {
  const glm::vec4 diagonal(0.6f, 0.8f, 0, 1);
  for (const Texel& texel : {red_slope, green_slope}) {
    const glm::dvec3 plain = mapped(with_tangents(texel, diagonal));
    const glm::dvec3 mirrored = mapped(with_tangents(texel, diagonal, {{"scale", {-1, 1, 1}}}));
    CHECK(glm::distance(mirrored, plain * glm::dvec3(-1, 1, 1)) < 1e-5);
    const glm::dvec3 larger = mapped(with_tangents(texel, diagonal, {{"scale", {3, 3, 3}}}));
    CHECK(glm::distance(larger, plain) < 1e-5);
    const double h = std::sqrt(0.5);
    const glm::dvec3 turned = mapped(with_tangents(texel, diagonal, {{"rotation", {0, 0, h, h}}}));
    CHECK(glm::distance(turned, glm::dvec3(-plain.y, plain.x, plain.z)) < 1e-5);
    // Turned upside down through x: seen from -z now, y and z are mirrored.
    const glm::dvec3 over =
        mapped(with_tangents(texel, diagonal, {{"scale", {1, 1, -1}}}), {0, 0, 1});
    CHECK(glm::distance(over, plain * glm::dvec3(1, 1, -1)) < 1e-5);
  }
}

TEST_CASE("from behind the bump of TANGENT is a dent") {
  const Scene scene = with_tangents(green_slope, {0, 1, 0, 1});
  CHECK(glm::distance(mapped(scene, {0, 0, 1}), -mapped(scene)) < 1e-5);
}

TEST_CASE("tangents that are no frame, or without normals, are not used") {
  const glm::dvec3 by_coordinates = sloping({1, 0, 0});
  const float infinity = std::numeric_limits<float>::infinity();
  for (const glm::vec4 broken :
       {glm::vec4(0), glm::vec4(0, NAN, 0, 1), glm::vec4(infinity, 0, 0, 1)}) {
    const Scene scene = with_tangents(red_slope, broken);
    CHECK(scene.corner_tangent.empty());
    CHECK(glm::distance(mapped(scene), by_coordinates) < resolution);
  }
  const Scene bare = with_tangents(red_slope, {0, 1, 0, 1}, json::object(),
                                   [](json& attributes) { attributes.erase("NORMAL"); });
  CHECK(bare.corner_tangent.empty());
  CHECK(glm::distance(mapped(bare), by_coordinates) < resolution);
}

TEST_CASE("tangents between corners are interpolated") {
  Scene scene = with_tangents(red_slope, {1, 0, 0, 1});
  // Half-way between along x and along y it is along the diagonal.
  scene.corner_tangent[0] = {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(1, 0, 0, 1)};
  const auto point = trace::surface_hit(scene, {0, 0.5f, 0.0f}, {0, 0, -1});
  const glm::dvec3 normal(trace::shading_normals(scene, point, {0, 0, -1}).mapped);
  CHECK(glm::distance(normal, sloping({std::sqrt(0.5), std::sqrt(0.5), 0})) < resolution);
}

TEST_CASE("scenes without normal maps carry no tangents") {
  json document = square_document();
  document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = 0;  // of the wrong type, too
  CHECK(load_gltf(document).corner_tangent.empty());
}

}  // namespace
}  // namespace photile::test
