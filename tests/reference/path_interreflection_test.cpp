// Light between surfaces, by the path tracer, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>

#include "path_irradiance.hpp"
#include "photile/device/bsdf.h"
#include "test_scenes.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

/// A closed box of 2 x 1 x 1.5 m whose walls reflect `albedo` and all emit the radiance 1.
SceneBuilder glowing_box(float albedo) {
  SceneBuilder builder("glowing box");
  const std::uint32_t wall = builder.add(diffuse(albedo));
  const std::uint32_t lamp = builder.add(area_light("walls", pi * 2 * (2 + 3 + 1.5)));
  const glm::vec3 x(2, 0, 0), y(0, 1, 0), z(0, 0, 1.5f), zero(0);
  builder.quad(zero, x, x + y, y, wall, lamp);
  builder.quad(z, z + y, z + x + y, z + x, wall, lamp);
  builder.quad(zero, y, y + z, z, wall, lamp);
  builder.quad(x, x + z, x + y + z, x + y, wall, lamp);
  builder.quad(zero, z, x + z, x, wall, lamp);
  builder.quad(y, y + x, y + x + z, y + z, wall, lamp);
  return builder;
}

/// A rough ball of `material`.
void add_ball(SceneBuilder& builder, const glm::vec3& centre, float radius, const Material& look) {
  const std::uint32_t material = builder.add(look);
  constexpr int rings = 10;
  const auto at = [&](int i, int j) {
    const float theta = glm::pi<float>() * static_cast<float>(i) / rings;
    const float phi = glm::pi<float>() * static_cast<float>(j % (2 * rings)) / rings;
    if (i == 0 || i == rings) return centre + glm::vec3(0, 0, i == 0 ? radius : -radius);
    return centre + radius * glm::vec3(std::sin(theta) * std::cos(phi),
                                       std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) builder.triangle(at(i, j), at(i + 1, j), at(i, j + 1), material);
      if (i + 1 < rings) builder.triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), material);
    }
  }
}

std::vector<double> times(double factor, std::vector<double> values) {
  for (double& value : values) value *= factor;
  return values;
}

const std::vector<Sensor> places{
    {{0.3, 0.7, 0}, {0, 0, 1}}, {{1.99, 0.02, 0}, {0, 0, 1}}, {{0, 0.4, 1.1}, {1, 0, 0}}};

TEST_CASE("in a furnace the irradiance is pi L / (1 - rho) everywhere") {
  for (const float albedo : {0.0f, 0.5f, 0.9f}) {
    const Scene scene = glowing_box(albedo).build();
    const double truth = pi / (1 - double{albedo});
    CHECK_VERDICT(mean_is(times(scene.lights[0].power, path_irradiances(scene, places, 8000)),
                          truth, 0.015 * truth));
  }
}

TEST_CASE("mirrors and glass that lose nothing leave a furnace as it is") {
  const Material look = GENERATE(mirror(1.0f), glass(1.5f), glass(1.5f, true));
  SceneBuilder builder = glowing_box(0.5f);
  add_ball(builder, {1, 0.5f, 0.6f}, 0.35f, look);
  const Scene scene = builder.build();
  CHECK_VERDICT(mean_is(times(scene.lights[0].power, path_irradiances(scene, places, 4000)), 2 * pi,
                        0.02 * 2 * pi));
}

TEST_CASE("in a closed box the mean irradiance is the flux over (1 - rho) times the area") {
  const Scene scene = closed_box(diffuse(0.7f));
  // The midpoint rule over the walls: the lamp is nowhere near them.
  std::vector<Sensor> sensors;
  constexpr int cells = 24;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          Sensor sensor{glm::dvec3(side), glm::dvec3(0)};
          sensor.position[(axis + 1) % 3] = (i + 0.5) / cells;
          sensor.position[(axis + 2) % 3] = (j + 0.5) / cells;
          sensor.normal[axis] = side == 0 ? 1 : -1;
          sensors.push_back(sensor);
        }
      }
    }
  }
  const double truth = 1 / (6 * 0.3);
  CHECK_VERDICT(mean_is(path_irradiances(scene, sensors, 20), truth, 0.01 * truth));
}

TEST_CASE("a glossy plate in a furnace reflects the integral of its BSDF, and receives pi L") {
  const float roughness = GENERATE(0.05f, 0.3f);
  const Material metal = glossy(0.2f, 0.6f, roughness);
  SceneBuilder builder = glowing_box(0.0f);
  const std::uint32_t plate = builder.add(metal);
  builder.quad({0.8f, 0.3f, 0.7f}, {1.2f, 0.3f, 0.7f}, {1.2f, 0.7f, 0.7f}, {0.8f, 0.7f, 0.7f},
               plate);
  const Scene scene = builder.build();
  // Seen from straight above, by quadrature of the lobe and of the base below it.
  const double truth = validation::glossy_reflectance(0.2, 0.6, double{roughness});
  std::vector<double> irradiance, radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto means = path_means(scene, {{{1, 0.5, 0.7}, {0, 0, 1}}}, seed, 40'000);
    irradiance.push_back(scene.lights[0].power * means.irradiance[0]);
    radiance.push_back(scene.lights[0].power * means.radiance[0]);
  }
  CHECK_VERDICT(mean_is(irradiance, pi, 0.02 * pi));
  CHECK_VERDICT(mean_is(radiance, truth, 0.02 * truth));
}

// Closed forms of form factors against their integrals.

using namespace validation;

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

}  // namespace
}  // namespace photile::test
