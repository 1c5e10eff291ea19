// Meshes that several nodes place stay instances, beside their flattened triangles.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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
