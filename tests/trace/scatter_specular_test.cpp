// Mirrors and glass against Snell's and Fresnel's laws.
#include <catch2/catch.hpp>

#include "statistical_tests.hpp"
#include "test_scenes.hpp"
#include "trace/scatter.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

/// Ray direction in the plane y = 0 at `angle` from straight down.
glm::vec3 downwards(double angle) {
  return {static_cast<float>(std::sin(angle)), 0.0f, static_cast<float>(-std::cos(angle))};
}

glm::vec3 upwards(double angle) {
  const glm::vec3 v = downwards(angle);
  return {v.x, v.y, -v.z};
}

Scattered scatter(const Scene& scene, const glm::vec3& direction, float choice) {
  return scatter_specular(scene, surface_hit(scene, {0, 0.2f, 0.5f}, direction), direction, choice);
}

constexpr float never_reflect = 0.9999999f;

/// Share of choices that reflect, over 100,000 evenly spaced ones.
double reflected_share(const Scene& scene, const glm::vec3& direction) {
  int reflected = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Scattered scattered = scatter(scene, direction, (static_cast<float>(i) + 0.5f) / 1e5f);
    reflected += scattered.direction.z * direction.z < 0;
  }
  return reflected / 1e5;
}

}  // namespace

TEST_CASE("A mirror sends a ray out at the angle it came in, from both sides, and tints it") {
  const glm::vec3 tint(0.9f, 0.8f, 0.7f);
  const Scene scene = plate(mirror(tint), 2);
  for (const double angle : {0.0, 0.3, 1.2, 1.57}) {
    const Scattered above = scatter(scene, downwards(angle), 0.5f);
    CHECK(glm::distance(above.direction, upwards(angle)) < 1e-6f);
    CHECK(above.weight == tint);
    CHECK(glm::distance(scatter(scene, upwards(angle), 0.5f).direction, downwards(angle)) < 1e-6f);
  }
}

TEST_CASE("Glass of index 1.5 reflects 4% at normal incidence, entering and leaving") {
  const Scene scene = plate(glass(1.5f), 2);
  CHECK(reflected_share(scene, downwards(0)) == Approx(0.04).margin(2e-5));
  CHECK(reflected_share(scene, upwards(0)) == Approx(0.04).margin(2e-5));
}

TEST_CASE(
    "Glass reflects what Fresnel's equations say in double, total beyond the critical angle") {
  const Scene scene = plate(glass(1.5f), 2);
  for (const double angle : {0.3, 0.8, 1.3}) {
    const double sin_t = std::sin(angle) / 1.5, t = std::asin(sin_t);
    const double s = std::sin(angle - t) / std::sin(angle + t);
    const double p = std::tan(angle - t) / std::tan(angle + t);
    const double reflectance = 0.5 * (s * s + p * p);
    CHECK(reflected_share(scene, downwards(angle)) == Approx(reflectance).margin(3e-5));
    // Along the same path backwards the reflectance is the same.
    CHECK(reflected_share(scene, upwards(t)) == Approx(reflectance).margin(3e-5));
  }
  CHECK(reflected_share(scene, upwards(std::asin(1 / 1.5) + 1e-3)) == 1.0);
  CHECK(reflected_share(scene, upwards(1.5)) == 1.0);
  CHECK(fresnel_dielectric(0.0f, 1 / 1.5f) == Approx(1));
}

TEST_CASE(
    "Glass bends a ray by Snell's law, and what enters at an angle leaves a slab at that angle") {
  const Scene scene = plate(glass(1.5f), 2);
  for (const double angle : {0.0, 0.3, 0.8, 1.3}) {
    const double inside = std::asin(std::sin(angle) / 1.5);
    CHECK(glm::distance(scatter(scene, downwards(angle), never_reflect).direction,
                        downwards(inside)) < 1e-6f);
    CHECK(glm::distance(scatter(scene, upwards(inside), never_reflect).direction, upwards(angle)) <
          2e-6f);
  }
}

TEST_CASE("Glass whose front is below is entered from below") {
  Scene scene = plate(glass(1.5f), 2);
  for (auto& front : scene.front_side) front ^= 1;
  const double inside = std::asin(std::sin(0.8) / 1.5);
  CHECK(glm::distance(scatter(scene, upwards(0.8), never_reflect).direction, upwards(inside)) <
        1e-6f);
}

TEST_CASE("Thin glass does not bend rays and reflects as a pane with two faces, from both sides") {
  const Scene scene = plate(glass(1.5f, true), 2);
  for (const double angle : {0.0, 0.8}) {
    CHECK(scatter(scene, downwards(angle), never_reflect).direction == downwards(angle));
    CHECK(scatter(scene, upwards(angle), never_reflect).direction == upwards(angle));
  }
  // The series F + (1-F)^2 F (1 + F^2 + F^4 + ...), summed term by term.
  const double f = 0.04;
  double reflectance = f;
  for (double term = (1 - f) * (1 - f) * f; term > 1e-12; term *= f * f) reflectance += term;
  CHECK(reflected_share(scene, downwards(0)) == Approx(reflectance).margin(2e-5));
  CHECK(reflected_share(scene, upwards(0)) == Approx(reflectance).margin(2e-5));
}

TEST_CASE("Glass tints what passes and not what it reflects") {
  Material green = glass(1.5f);
  green.transmission = {0.2f, 0.9f, 0.3f};
  const Scene scene = plate(green, 2);
  CHECK(scatter(scene, downwards(0.3), never_reflect).weight == green.transmission);
  CHECK(scatter(scene, downwards(0.3), 0.0f).weight == glm::vec3(1.0f));
}

TEST_CASE("A steep shading normal sends no ray to the wrong side of a mirror or of glass") {
  for (const Material& material : {mirror(glm::vec3(1.0f)), glass(1.5f)}) {
    Scene scene = plate(material, 2);
    const glm::vec3 steep = glm::normalize(glm::vec3(-1.0f, 0.0f, 0.2f));
    scene.corner_normal.assign(scene.triangle_count(), {steep, steep, steep});
    for (const double angle : {0.1, 0.8, 1.4}) {
      CHECK(scatter(scene, downwards(angle), 0.0f).direction.z > 0);
      if (material.interaction == Interaction::glass)
        CHECK(scatter(scene, downwards(angle), never_reflect).direction.z < 0);
    }
  }
}

TEST_CASE("Radiance loses the squared index on the way into the eye, and gets it back beyond") {
  const Scene solid = plate(glass(1.5f), 2);
  const double inside = std::asin(std::sin(0.8) / 1.5);
  const Scattered in = scatter(solid, downwards(0.8), never_reflect);
  const Scattered out = scatter(solid, upwards(inside), never_reflect);
  CHECK(in.radiance_factor == Approx(1 / 2.25));
  CHECK(out.radiance_factor == Approx(2.25));
  CHECK(static_cast<float>(in.radiance_factor * out.radiance_factor) == 1.0f);
  CHECK(scatter(solid, downwards(0.8), 0.0f).radiance_factor == 1);
  CHECK(scatter(solid, upwards(1.2), never_reflect).radiance_factor == 1);  // total reflection
  CHECK(scatter(plate(glass(1.5f, true), 2), downwards(0.8), never_reflect).radiance_factor == 1);
  CHECK(scatter(plate(mirror(glm::vec3(1.0f)), 2), downwards(0.8), 0.5f).radiance_factor == 1);
}

}  // namespace photile::test
