// What belongs to one sheet of surface, and what light reaches with it.
#include "surface/sheets.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "photon_sets.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

constexpr double sheet_radius = 0.1;

surface::Sheets sheets_of(const Scene& scene, double angle = 60) {
  return surface::find_sheets(surface::SurfaceMesh(scene), sheet_radius, angle);
}

/// Sheets of the sides that look along +z.
std::set<std::uint32_t> sheets_facing_up(const Scene& scene) {
  const surface::Sheets sheets = sheets_of(scene);
  std::set<std::uint32_t> found;
  for (std::uint32_t s = 0; s < sheets.of.size(); ++s) {
    if (sided_normal(scene, s).z > 0.9) found.insert(sheets.of[s]);
  }
  return found;
}

}  // namespace

TEST_CASE("a plate of any triangulation has two sheets, its sides") {
  for (const int cells : {1, 5}) {
    const Scene scene = test::plate(test::diffuse(glm::vec3(0.5f)), 1.0f, cells);
    const surface::Sheets sheets = sheets_of(scene);
    CHECK(sheets.count == 2);
    CHECK(sheets_facing_up(scene).size() == 1);
  }
}

TEST_CASE("a box has twelve sheets, and two where its edges do not part them") {
  test::SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(test::diffuse(glm::vec3(0.5f))), false,
              3);
  const Scene scene = builder.build();
  CHECK(sheets_of(scene, 60).count == 12);
  CHECK(sheets_of(scene, 91).count == 2);
}

TEST_CASE("sheets of a curved surface follow it round, however its triangles are wound") {
  Scene scene = test::empty_scene();
  test::add_torus(scene, 1.0f, 0.4f, 24, 16);
  CHECK(sheets_of(scene).count == 2);
  // Corners in another order turn a triangle's sides over.
  for (std::size_t t = 0; t < scene.triangle_count(); t += 3) {
    std::swap(scene.triangles[t].y, scene.triangles[t].z);
  }
  CHECK(sheets_of(scene).count == 2);
}

TEST_CASE("coplanar pieces that touch make one sheet without a common corner") {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({1, 0.2f, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);  // as tiles are laid
  CHECK(sheets_facing_up(builder.build()).size() == 1);
  builder.grid({2.5f, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);  // half a metre beyond
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("wherever they lie, pieces connect along a longer edge, and not beyond its end") {
  for (const float shift : {-3.0f, 0.0f, 3.0f}) {
    const auto sheets_beside = [&](float from, float to) {
      test::SceneBuilder builder;
      const std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));
      builder.grid({0, shift, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
      builder.grid({1, shift + from, 0}, {1, 0, 0}, {0, to - from, 0}, 1, white);
      return sheets_facing_up(builder.build()).size();
    };
    CAPTURE(shift);
    CHECK(sheets_beside(-0.5f, 1.5f) == 1);
    CHECK(sheets_beside(1.5f, 2.5f) == 2);
  }
}

TEST_CASE("pieces that overlap in a plane stay apart") {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 0.5f, 0}, 1, white);  // from the same edge on
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("mirrors are no part of the sheets of what is round them") {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.add(test::diffuse(glm::vec3(0.5f)));
  const std::uint32_t silver = builder.add(test::mirror(glm::vec3(0.9f)));
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, white);
  builder.grid({1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, silver);
  CHECK(sheets_facing_up(builder.build()).size() == 2);
}

TEST_CASE("of coincident triangles the first stands for all, on the side that looks as they do") {
  Scene scene = test::empty_scene();
  test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::add_triangle(scene, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});  // wound the other way
  test::add_triangle(scene, {1, 0, 0}, {0, 1, 0}, {0, 0, 0});
  const surface::SurfaceMesh mesh(scene);
  CHECK(mesh.original == std::vector<std::uint32_t>{0, 1, 1, 0, 0, 1});
}

}  // namespace photile::test
