// Light that comes straight from lamps, by the path tracer, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>

#include "path_irradiance.hpp"
#include "suns.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

const glm::dvec3 up(0, 0, 1);
const Material black = diffuse(0.0f);

double irradiance(const Scene& scene, const glm::dvec3& position) {
  return path_means(scene, {{position, up}}, 1, 1).irradiance.at(0);
}

/// A black floor under a lamp of 0.8 x 0.6 m that faces down, 1 m above the floor's middle.
Scene floor_under_lamp(bool two_sided, bool turned, const Material& floor = black) {
  SceneBuilder builder;
  const std::uint32_t material = builder.add(floor);
  const std::uint32_t dark = builder.add(black);
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, material);
  const std::uint32_t lamp = builder.add(area_light("lamp", 1.0, two_sided));
  const glm::vec3 u(0.8f, 0, 0), v(0, 0.6f, 0), origin(-0.4f, -0.3f, 1);
  builder.grid(origin, turned ? u : v, turned ? v : u, 2, dark, lamp);
  return builder.build();
}

/// Irradiance at a floor point from that lamp, which emits 1 lm from one side.
double lamp_irradiance(const glm::dvec3& point) {
  return validation::rectangle_factor(point, up, {-0.4, -0.3, 1}, {0.8, 0, 0}, {0, 0.6, 0}) /
         (0.8 * 0.6);
}

/// Irradiance below the middle of a lamp of 2 x 2 m, 1 m high, that emits 1 lm through a pane of
/// index 1.5: the midpoint rule, with both polarisations of Fresnel's equations.
double pane_under_lamp() {
  constexpr int cells = 400;
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const double x = 2 * (i + 0.5) / cells - 1, y = 2 * (j + 0.5) / cells - 1;
      const double squared = x * x + y * y + 1, theta = std::acos(1 / std::sqrt(squared));
      const double inside = std::asin(std::sin(theta) / 1.5);
      const double s = std::sin(theta - inside) / std::sin(theta + inside);
      const double p = std::tan(theta - inside) / std::tan(theta + inside);
      const double fresnel = 0.5 * (s * s + p * p);
      sum += (1 - fresnel) / (1 + fresnel) / (squared * squared);
    }
  }
  return sum / (cells * cells) / pi;  // radiance 1 / (pi A), area A / cells^2
}

}  // namespace

TEST_CASE("a point light gives intensity times cosine over squared distance, without noise") {
  Scene scene = plate(black, 6.0f, 2);
  scene.lights.push_back(point_light("lamp", {0.3f, -0.2f, 1.5f}));
  for (const glm::dvec3& point : {glm::dvec3(0.3, -0.2, 0), glm::dvec3(2, 1, 0)}) {
    const glm::dvec3 offset = glm::dvec3(0.3, -0.2, 1.5) - point;
    const double distance = glm::length(offset);
    CHECK(irradiance(scene, point) ==
          Approx(offset.z / (4 * pi * std::pow(distance, 3))).epsilon(1e-5));
  }
}

TEST_CASE(
    "a spot light has full intensity in its inner cone, none beyond its outer, all its flux") {
  Scene scene = plate(black, 6.0f, 1);
  scene.lights.push_back(spot_light("spot", {0, 0, 1}, {0, 0, -1}, 0.3f, 0.6f));
  const double inner = std::cos(0.3), outer = std::cos(0.6);
  // Flux of intensity 1: the inner cap, and the falloff by the midpoint rule.
  double flux = 2 * pi * (1 - inner);
  constexpr int steps = 100'000;
  for (int i = 0; i < steps; ++i) {
    const double share = (i + 0.5) / steps;
    flux += 2 * pi * share * share * (inner - outer) / steps;
  }
  CHECK(irradiance(scene, {0, 0, 0}) == Approx(1 / flux).epsilon(1e-5));
  const double halfway = std::tan(std::acos(0.5 * (inner + outer)));
  const double cosine = 0.5 * (inner + outer);
  CHECK(irradiance(scene, {halfway, 0, 0}) ==
        Approx(0.25 / flux * std::pow(cosine, 3)).epsilon(1e-4));
  CHECK(irradiance(scene, {0, std::tan(0.61), 0}) == 0);
}

TEST_CASE("a directional light spreads its flux over the disc of the scene's bounding sphere") {
  Scene scene = plate(black, 2.0f, 1);
  scene.lights.push_back(sun_along(glm::normalize(glm::vec3(0.6f, 0, -0.8f))));
  CHECK(irradiance(scene, {0.1, 0.2, 0}) == Approx(0.8 / (pi * 2)).epsilon(1e-5));
}

TEST_CASE("an area light gives its form factor times its radiance") {
  const Scene scene = floor_under_lamp(false, false);
  for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), glm::dvec3(0.7, 0.9, 0)}) {
    const double truth = lamp_irradiance(point);
    CHECK_VERDICT(mean_is(path_irradiances(scene, {{point, up}}, 4000), truth, 0.02 * truth));
  }
}

TEST_CASE("a lamp gives nothing from its back, and half from each side where it has two") {
  CHECK(path_means(floor_under_lamp(false, true), {{{0, 0, 0}, up}}, 1, 2000).irradiance.at(0) ==
        0);
  for (const bool turned : {false, true}) {
    const double truth = 0.5 * lamp_irradiance({0, 0, 0});
    CHECK_VERDICT(mean_is(path_irradiances(floor_under_lamp(true, turned), {{{0, 0, 0}, up}}, 4000),
                          truth, 0.02 * truth));
  }
}

TEST_CASE("a black wall hides what is behind it") {
  Scene scene = plate(black, 6.0f, 1);
  SceneBuilder builder;
  const std::uint32_t material = builder.add(black);
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, material);
  builder.grid({0.5f, -3, 0}, {0, 6, 0}, {0, 0, 1}, 1, material);
  builder.add(point_light("lamp", {0, 0, 1}));
  scene = builder.build();
  CHECK(irradiance(scene, {0.4, 0, 0}) > 0);
  CHECK(irradiance(scene, {1.0, 0, 0}) == 0);
}

TEST_CASE("a pane of thin glass passes what Fresnel's equations say, from lamps of every kind") {
  // Straight on: F = ((n - 1) / (n + 1))^2 at each face, (1 - F) / (1 + F) through both.
  const double fresnel = 0.04, passed = (1 - fresnel) / (1 + fresnel);
  SceneBuilder builder;
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, builder.add(black));
  builder.grid({-3, -3, 0.5f}, {6, 0, 0}, {0, 6, 0}, 1, builder.add(glass(1.5f, true)));
  Scene with_point = builder.build();
  with_point.lights.push_back(point_light("lamp", {0, 0, 1}));
  CHECK(irradiance(with_point, {0, 0, 0}) == Approx(passed / (4 * pi)).epsilon(1e-5));

  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.grid({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, 1, 0, lamp);
  const double truth = pane_under_lamp();
  CHECK_VERDICT(
      mean_is(path_irradiances(builder.build(), {{{0, 0, 0}, up}}, 20'000), truth, 0.02 * truth));
}

TEST_CASE("a mirror shows the lamp's image") {
  // The lamp faces up; a mirror 1 m above it shows it 2 m above where it is.
  SceneBuilder builder;
  const std::uint32_t floor = builder.add(black);
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, floor);
  builder.grid({-6, -6, 1}, {0, 12, 0}, {12, 0, 0}, 1, builder.add(mirror(0.9f)));
  const std::uint32_t lamp = builder.add(area_light("lamp"));
  builder.grid({0.5f, -1.5f, 0.5f}, {1, 0, 0}, {0, 3, 0}, 1, floor, lamp);
  const double truth =
      0.9 / 3 * validation::rectangle_factor({0, 0, 0}, up, {0.5, -1.5, 1.5}, {1, 0, 0}, {0, 3, 0});
  CHECK_VERDICT(
      mean_is(path_irradiances(builder.build(), {{{0, 0, 0}, up}}, 60'000), truth, 0.03 * truth));
}

TEST_CASE("each light of many is measured at its own power 1") {
  Scene scene = plate(black, 4.0f, 1);
  for (int i = 0; i < 3; ++i) {
    scene.lights.push_back(point_light("lamp " + std::to_string(i),
                                       {0, 0, static_cast<float>(1 + i)}, std::pow(10, i)));
  }
  std::vector<std::vector<double>> values(3);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto means = path_means(scene, {{{0, 0, 0}, up}}, seed, 20'000);
    for (std::size_t light = 0; light < 3; ++light) {
      values[light].push_back(means.irradiance[light]);
    }
  }
  for (std::size_t light = 0; light < 3; ++light) {
    const double truth = 1 / (4 * pi * std::pow(static_cast<double>(light + 1), 2));
    CHECK_VERDICT(mean_is(values[light], truth, 0.06 * truth));
  }
}

}  // namespace photile::test
