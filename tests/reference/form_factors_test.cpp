// Closed forms of form factors against their integrals.
#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using namespace photile::validation;
using std::numbers::pi;

/// Factor from a point to a parallelogram by the midpoint rule.
double integral(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& origin,
                const glm::dvec3& u, const glm::dvec3& v, int cells) {
  const glm::dvec3 across = glm::cross(u, v) / static_cast<double>(cells * cells);
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const glm::dvec3 offset = origin + (i + 0.5) / cells * u + (j + 0.5) / cells * v - point;
      const double squared = glm::dot(offset, offset);
      sum += std::max(0.0, glm::dot(offset, normal)) * std::abs(glm::dot(offset, across)) /
             (squared * squared);
    }
  }
  return sum / glm::pi<double>();
}

/// Factor between two parallelograms by the midpoint rule over the first.
double mean_integral(const glm::dvec3& from, const glm::dvec3& from_u, const glm::dvec3& from_v,
                     const glm::dvec3& normal, const glm::dvec3& origin, const glm::dvec3& u,
                     const glm::dvec3& v, int cells) {
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const glm::dvec3 point = from + (i + 0.5) / cells * from_u + (j + 0.5) / cells * from_v;
      sum += rectangle_factor(point, normal, origin, u, v);
    }
  }
  return sum / (cells * cells);
}

const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

}  // namespace

TEST_CASE("the factor from a point to a rectangle is its integral") {
  const glm::dvec3 point(0.2, -0.3, 0.1), tilted = glm::normalize(glm::dvec3(0.2, 0.1, 1));
  for (const glm::dvec3& normal : {z, tilted}) {
    const glm::dvec3 origin(-0.5, -1, 1.2), u(1.5, 0, 0.2), v(0, 2, 0);
    CHECK(rectangle_factor(point, normal, origin, u, v) ==
          Approx(integral(point, normal, origin, u, v, 1500)).epsilon(1e-5));
  }
}

TEST_CASE("the factor from a point to a rectangle is Howell's for a corner straight above") {
  // Catalog C-1: a = 2, b = 1, c = 1.
  const double expected = (2 / std::sqrt(5.0) * std::atan(1 / std::sqrt(5.0)) +
                           1 / std::sqrt(2.0) * std::atan(2 / std::sqrt(2.0))) /
                          glm::two_pi<double>();
  CHECK(rectangle_factor({0, 0, 0}, z, {0, 0, 1}, 2.0 * x, y) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("the factor between opposed rectangles is the mean of its points'") {
  CHECK(
      opposed_rectangles_factor(2, 1, 1.5) ==
      Approx(mean_integral({0, 0, 0}, 2.0 * x, y, z, {0, 0, 1.5}, 2.0 * x, y, 300)).epsilon(1e-5));
}

TEST_CASE("the factor between perpendicular rectangles is the mean of its points'") {
  CHECK(perpendicular_rectangles_factor(2, 1, 1.5) ==
        Approx(mean_integral({0, 0, 0}, 2.0 * x, 1.5 * y, z, {0, 0, 0}, 1.5 * y, z, 2000))
            .epsilon(1e-4));
}

TEST_CASE("factors to all walls of a box sum to one") {
  const double sides =
      2 * perpendicular_rectangles_factor(2, 1, 3) + 2 * perpendicular_rectangles_factor(3, 1, 2);
  CHECK(sides + opposed_rectangles_factor(2, 3, 1) == Approx(1).epsilon(1e-12));
}

}  // namespace photile::test
