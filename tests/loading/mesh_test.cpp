// Meshes: their triangles, sides and bounds.
#include <catch2/catch.hpp>
#include <cmath>

#include "scene/mesh_builder.hpp"
#include "scene_files.hpp"

namespace photile::test {
namespace {

using scene::Corner;
using scene::MeshBuilder;

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

}  // namespace

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
    CHECK(glm::dot(face_normal(scene, oriented(0, scene.front_side[0])), front) > 0.0);
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
  CHECK(std::isfinite(face_normal(scene, oriented(0, 1)).y));
}

TEST_CASE("area and normal of a triangle are those of its closed form") {
  Scene scene;
  MeshBuilder builder(scene, {});
  builder.add({Corner{{0, 0, 0}, {}, {}}, Corner{{3, 0, 0}, {}, {}}, Corner{{0, 4, 0}, {}, {}}}, 0,
              none);
  CHECK(triangle_area(scene, 0) == Approx(6.0));
  CHECK(face_normal(scene, oriented(0, 0)) == -face_normal(scene, oriented(0, 1)));
  CHECK(std::abs(face_normal(scene, 0).z) == Approx(1.0));
}

TEST_CASE("the bounding sphere goes through the corners of the bounding box") {
  Scene scene;
  scene.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {1, 1, 4}};
  CHECK(bounding_sphere(scene).center == glm::dvec3(1, 2, 2));
  CHECK(bounding_sphere(scene).radius == Approx(3.0));
}

}  // namespace photile::test
