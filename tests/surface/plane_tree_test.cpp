// The search for triangles of other planes, beside all pairs.
#include <catch2/catch.hpp>
#include <set>

#include "photon_sets.hpp"
#include "surface/facets.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// Triangles of other facets within the radius, by looking at all.
std::set<std::uint32_t> others_within(const surface::SurfaceMesh& mesh,
                                      const surface::Facets& facets, std::uint32_t triangle,
                                      double radius) {
  const geometry::Box box = geometry::triangle_box(mesh.scene, triangle);
  std::set<std::uint32_t> found;
  for (std::uint32_t other = 0; other < mesh.scene.triangle_count(); ++other) {
    if (mesh.counts(other) && facets.plane[other] != facets.plane[triangle] &&
        geometry::squared_distance(box, geometry::triangle_box(mesh.scene, other)) <=
            radius * radius) {
      found.insert(other);
    }
  }
  return found;
}

}  // namespace

TEST_CASE("triangles of other planes are all found, and none of the own") {
  test::SceneBuilder builder;
  const std::uint32_t material = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), material, true, 12);
  builder.box(glm::vec3(0.2f, 0.2f, 0.01f), glm::vec3(0.5f), material, false, 5);
  Scene scene = builder.build();
  test::add_torus(scene, 0.3f, 0.1f, 12, 8);
  const surface::SurfaceMesh mesh(scene);
  for (const double radius : {0.02, 0.15}) {
    const surface::Facets facets = surface::find_facets(mesh, radius);
    const surface::PlaneTree planes(mesh, facets);
    for (std::uint32_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
      std::set<std::uint32_t> visited;
      planes.visit_others(triangle, geometry::triangle_box(scene, triangle), radius,
                          [&](std::uint32_t other) {
                            visited.insert(other);
                            return false;
                          });
      bool own_plane = false, missed = false;
      for (const std::uint32_t other : visited) {
        own_plane |= facets.plane[other] == facets.plane[triangle];
      }
      for (const std::uint32_t other : others_within(mesh, facets, triangle, radius)) {
        missed |= visited.count(other) == 0;
      }
      INFO("triangle " << triangle << ", radius " << radius);
      REQUIRE(!own_plane);
      REQUIRE(!missed);
    }
  }
}

TEST_CASE("of two triangles at an angle each finds the other") {
  Scene scene = test::empty_scene();
  test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  const surface::SurfaceMesh mesh(scene);
  const surface::Facets facets = surface::find_facets(mesh, 0.1);
  const surface::PlaneTree planes(mesh, facets);
  for (const std::uint32_t triangle : {0u, 1u}) {
    std::vector<std::uint32_t> found;
    planes.visit_others(triangle, geometry::triangle_box(scene, triangle), 0.1,
                        [&](std::uint32_t other) {
                          found.push_back(other);
                          return false;
                        });
    CHECK(found == std::vector<std::uint32_t>{1 - triangle});
  }
}

TEST_CASE("a search for triangles of other planes ends where it is told to") {
  test::SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(test::diffuse(glm::vec3(0.5f))), true,
              4);
  const Scene scene = builder.build();
  const surface::SurfaceMesh mesh(scene);
  const surface::Facets facets = surface::find_facets(mesh, 0.1);
  const surface::PlaneTree planes(mesh, facets);
  int visits = 0;
  planes.visit_others(0, geometry::triangle_box(scene, 0), 2.0,
                      [&](std::uint32_t) { return ++visits == 3; });
  CHECK(visits == 3);
}

}  // namespace photile::test
