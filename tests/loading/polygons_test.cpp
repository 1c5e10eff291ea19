#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "reading/triangles.hpp"

namespace photile::test {
namespace {

glm::dvec3 area_vector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  return 0.5 * glm::cross(b - a, c - a);
}

/// Checks that the triangles tile a planar polygon: their oriented areas all point the polygon's
/// way, and sum to its area by the shoelace formula.
void check_tiling(const std::vector<glm::dvec3>& polygon) {
  const reading::Triangulation result = reading::triangulate_polygon(polygon);
  CHECK(result.simple);
  CHECK(result.triangles.size() == polygon.size() - 2);
  glm::dvec3 expected(0.0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    expected += 0.5 * glm::cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  double sum = 0.0;
  for (const auto& [a, b, c] : result.triangles) {
    const glm::dvec3 area = area_vector(polygon[a], polygon[b], polygon[c]);
    CHECK(glm::dot(area, expected) >= -1e-12);
    sum += glm::length(area);
  }
  CHECK(sum == Approx(glm::length(expected)).epsilon(1e-9));
}

/// A star polygon around the origin: simple, mostly concave, in a tilted plane.
std::vector<glm::dvec3> star(int corners, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> radius(0.1, 1.0);
  const glm::dmat3 tilt(glm::rotate(glm::dmat4(1.0), 1.1, glm::dvec3(1.0, 2.0, 3.0)));
  std::vector<glm::dvec3> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners, r = radius(generator);
    polygon.push_back(tilt * glm::dvec3(r * std::cos(angle), r * std::sin(angle), 0.0));
  }
  return polygon;
}

TEST_CASE("concave polygons are tiled: area against the shoelace formula") {
  check_tiling({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}});
  check_tiling(
      {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  for (unsigned seed = 0; seed < 20; ++seed)
    check_tiling(star(5 + static_cast<int>(seed) * 3, seed));
}

TEST_CASE("polygons with corners on their straight edges are tiled") {
  check_tiling(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
}

TEST_CASE("a dart is split along its only diagonal inside") {
  const reading::Triangulation dart = reading::triangulate_polygon(
      std::vector<glm::dvec3>{{0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0}});
  REQUIRE(dart.triangles.size() == 2);
  for (const auto& triangle : dart.triangles) {
    CHECK(std::count(triangle.begin(), triangle.end(), 0u) == 1);
    CHECK(std::count(triangle.begin(), triangle.end(), 2u) == 1);
  }
}

TEST_CASE("the triangles of a polygon depend neither on its winding nor on its first corner") {
  const std::vector<glm::dvec3> polygon = star(17, 3);
  const auto positions = [](const std::vector<glm::dvec3>& corners) {
    std::vector<std::vector<double>> result;
    for (const auto& triangle : reading::triangulate_polygon(corners).triangles) {
      std::vector<double> sorted;
      for (const std::uint32_t i : triangle) {
        sorted.insert(sorted.end(), {corners[i].x, corners[i].y, corners[i].z});
      }
      std::sort(sorted.begin(), sorted.end());
      result.push_back(sorted);
    }
    return result;
  };
  std::vector<glm::dvec3> reversed(polygon.rbegin(), polygon.rend()), rotated = polygon;
  std::rotate(rotated.begin(), rotated.begin() + 5, rotated.end());
  CHECK(positions(reversed) == positions(polygon));
  CHECK(positions(rotated) == positions(polygon));
}

TEST_CASE("a polygon that crosses itself is told from a simple one") {
  CHECK_FALSE(reading::triangulate_polygon(
                  std::vector<glm::dvec3>{{0, 0, 0}, {4, 3, 0}, {4, 0, 0}, {0, 2, 0}, {-1, 1, 0}})
                  .simple);
}

TEST_CASE("polygons without area give triangles for the caller to drop, and end") {
  CHECK(
      reading::triangulate_polygon(std::vector<glm::dvec3>(6, glm::dvec3(1.0))).triangles.size() ==
      4);
  CHECK(reading::triangulate_polygon(
            std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}})
            .triangles.size() == 2);
}

}  // namespace
}  // namespace photile::test
