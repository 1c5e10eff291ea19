// Facets: their extent, and the edges that bound them.
#include "surface/facets.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "photile/device/surface.h"
#include "photon_sets.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

double border_length(const surface::Facets& facets) {
  double length = 0;
  for (const surface::BorderEdge& edge : facets.borders)
    length += glm::distance(edge.from, edge.to);
  return length;
}

}  // namespace

TEST_CASE("a plate is one facet, bounded by its outline, for any triangulation") {
  for (const int cells : {1, 3, 20}) {
    const Scene scene = test::plate(test::diffuse(glm::vec3(0.5f)), 1.0f, cells);
    const surface::Facets facets = surface::find_facets(surface::SurfaceMesh(scene), 0.1);
    const std::set<std::uint32_t> numbers(facets.of_triangle.begin(), facets.of_triangle.end());
    CHECK(numbers.size() == 1);
    CHECK(numbers.count(PHOTILE_NO_FACET) == 0);
    CHECK(facets.borders.size() == static_cast<std::size_t>(4 * cells));
    CHECK(border_length(facets) == Approx(4.0));
    for (const surface::BorderEdge& edge : facets.borders) {
      const glm::vec3 middle = 0.5f * (edge.from + edge.to);
      CHECK(glm::length(edge.inward) == Approx(1.0));
      CHECK(glm::dot(edge.inward, middle) == Approx(-0.5));  // towards the plate's centre
    }
  }
}

TEST_CASE("faces of a box bound each other; small ones are looked at triangle by triangle") {
  test::SceneBuilder builder;
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(test::diffuse(glm::vec3(0.5f))), false,
              4);
  const Scene scene = builder.build();
  const surface::SurfaceMesh mesh(scene);
  const surface::Facets large = surface::find_facets(mesh, 0.1);
  CHECK(border_length(large) == Approx(24.0));
  const surface::Facets small = surface::find_facets(mesh, 2.0);
  CHECK(small.borders.empty());
  CHECK(std::set<std::uint32_t>(small.plane.begin(), small.plane.end()).size() == 6);
}

TEST_CASE("a curved surface has no facets, and slow curvature adds up") {
  Scene scene = test::empty_scene();
  test::add_torus(scene, 1.0f, 0.4f, 24, 16);
  CHECK(surface::find_facets(surface::SurfaceMesh(scene), 0.3).borders.empty());
  // A cylinder of 1 km: neighbouring strips of 2 cm fold by 2e-5 rad, as flat as rounding leaves a
  // plane. Over its 40 m the normals turn by 0.04 rad.
  Scene slow = test::empty_scene();
  const auto at = [](int i) { return glm::vec3(0.02f * static_cast<float>(i), 0.0f, 0.0f); };
  const auto height = [](glm::vec3 p) { return glm::vec3(p.x, p.y, p.x * p.x / 2000.0f); };
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 up(0, 1, 0), a = height(at(i)), b = height(at(i + 1));
    test::add_triangle(slow, a, b, b + up);
    test::add_triangle(slow, a, b + up, a + up);
  }
  const surface::Facets facets = surface::find_facets(surface::SurfaceMesh(slow), 0.1);
  std::map<std::uint32_t, std::pair<double, double>> lean;  // of each facet's normals
  const surface::SurfaceMesh mesh(slow);
  for (std::uint32_t t = 0; t < slow.triangle_count(); ++t) {
    const double x = mesh.normal[t].x;
    const auto [entry, isnew] = lean.try_emplace(facets.plane[t], x, x);
    entry->second = {std::min(entry->second.first, x), std::max(entry->second.second, x)};
  }
  CHECK(lean.size() > 20);
  for (const auto& [plane, range] : lean) CHECK(range.second - range.first < 2e-3);
}

TEST_CASE("an edge of three triangles in a plane bounds all of them") {
  Scene scene = test::empty_scene();
  test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::add_triangle(scene, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  test::add_triangle(scene, {1, 0, 0}, {2, 2, 0}, {0, 1, 0});  // overlaps the second
  const surface::Facets facets = surface::find_facets(surface::SurfaceMesh(scene), 0.1);
  CHECK(std::set<std::uint32_t>(facets.plane.begin(), facets.plane.end()).size() == 3);
}

}  // namespace photile::test
