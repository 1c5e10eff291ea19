// Cube maps against OpenGL's table of their faces and against integrals in closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "cube_faces.hpp"
#include "pictures/textures.hpp"

namespace photile::test {
namespace {

using pictures::CubeMap;
using std::numbers::pi;

TEST_CASE("each texel of a cube map lies where OpenGL has it, flipped", "[cube_map]") {
  constexpr int side = 5;
  int number = 0;
  const CubeMap cube = cube_of(side, [&](const glm::dvec3&) { return glm::vec3(number++); });
  number = 0;
  for (std::size_t face = 0; face < 6; ++face) {
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        CAPTURE(face, row, column);
        const glm::dvec3 direction = texel_direction(face, column, row, side);
        CHECK(pictures::radiance_towards(cube, direction) == glm::vec3(number++));
      }
    }
  }
}

TEST_CASE("edges and corners of the cube belong to a face that meets there", "[cube_map]") {
  const CubeMap cube = cube_of(4, [](const glm::dvec3& d) { return glm::vec3(d); });
  for (const glm::dvec3 direction :
       {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, -1), glm::dvec3(1, -1, 0), glm::dvec3(0, 1, -1)}) {
    const glm::dvec3 unit = glm::normalize(direction);
    CHECK(glm::distance(glm::dvec3(pictures::radiance_towards(cube, unit)), unit) < 0.5);
  }
}

/// A light from above and from the side, without symmetry.
glm::vec3 uneven(const glm::dvec3& d) {
  return glm::vec3(1 + 0.5 * d.x + 0.25 * d.y, 2 + d.y * d.y, 1 + 0.9 * d.z);
}

TEST_CASE("the equirectangular map of a cube has its radiance and its integral", "[cube_map]") {
  const CubeMap cube = cube_of(64, uneven);
  const EnvironmentMap map = pictures::environment_of(cube, glm::dquat(1.0, 0.0, 0.0, 0.0), "cube");
  CHECK(map.name() == "cube");
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    // A texel of either map spans 1.4 degrees.
    CHECK(glm::distance(map.radiance(glm::vec3(d)), uneven(d)) < 0.1f);
  }
  // Odd powers vanish, and the mean of y^2 over the sphere is a third.
  CHECK(map.integral().r == Approx(4 * pi).epsilon(1e-3));
  CHECK(map.integral().g == Approx(4 * pi * (2 + 1.0 / 3)).epsilon(1e-3));
  CHECK(map.integral().b == Approx(4 * pi).epsilon(1e-3));
}

TEST_CASE("a rotation turns the surroundings, by any axis", "[cube_map]") {
  const CubeMap cube = cube_of(64, uneven);
  const glm::dquat rotation = glm::angleAxis(1.1, glm::normalize(glm::dvec3(0.3, -0.5, 0.8)));
  const EnvironmentMap map = pictures::environment_of(cube, rotation, "turned");
  for (const glm::dvec3 d : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1),
                             glm::normalize(glm::dvec3(1, -2, 3))}) {
    CHECK(glm::distance(map.radiance(glm::vec3(rotation * d)), uneven(d)) < 0.1f);
  }
}

TEST_CASE("a patch of sky keeps its flux wherever it is turned", "[cube_map]") {
  // A cap of 20 degrees around +z.
  const CubeMap cube = cube_of(128, [](const glm::dvec3& d) {
    return glm::vec3(d.z > std::cos(20 * pi / 180) ? 100.0f : 0.0f);
  });
  const double expected = 100 * 2 * pi * (1 - std::cos(20 * pi / 180));
  for (const double angle : {0.0, 0.4, pi / 2, 2.0}) {
    const glm::dquat rotation = glm::angleAxis(angle, glm::dvec3(1, 0, 0));  // over a pole
    CHECK(pictures::environment_of(cube, rotation, "cap").integral().g ==
          Approx(expected).epsilon(0.01));
  }
}

}  // namespace
}  // namespace photile::test
