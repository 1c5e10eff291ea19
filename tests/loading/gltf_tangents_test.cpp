// TANGENT of glTF meshes: which way normal maps turn the normals where the file says it.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "scene_invariants.hpp"
#include "textured_square.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

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

}  // namespace

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

}  // namespace photile::test
