// Paths against closed forms.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <numbers>

#include "path_irradiance.hpp"
#include "photile/device/bsdf.h"
#include "photile/renderer.hpp"
#include "smooth_meshes.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using namespace photile::validation;
using std::numbers::pi;

// Closed forms of form factors against their integrals.

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

// Light that comes straight from lamps, by the path tracer, against closed forms.

const glm::dvec3 up(0, 0, 1);
const Material black = test::diffuse(glm::vec3(0.0f));
using std::numbers::pi;

double irradiance(const Scene& scene, const glm::dvec3& position) {
  return test::path_means(scene, {{position, up}}, 1, 1).irradiance.at(0);
}

/// A black floor under a lamp of 0.8 x 0.6 m that faces down, 1 m above the floor's middle.
Scene floor_under_lamp(bool two_sided, bool turned, const Material& floor = black) {
  test::SceneBuilder builder;
  const std::uint32_t material = builder.add(floor);
  const std::uint32_t dark = builder.add(black);
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, material);
  const std::uint32_t lamp = builder.add(test::area_light("lamp", 1.0, two_sided));
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

TEST_CASE("a point light gives intensity times cosine over squared distance, without noise") {
  Scene scene = test::plate(black, 6.0f, 2);
  scene.lights.push_back(test::point_light("lamp", {0.3f, -0.2f, 1.5f}));
  for (const glm::dvec3& point : {glm::dvec3(0.3, -0.2, 0), glm::dvec3(2, 1, 0)}) {
    const glm::dvec3 offset = glm::dvec3(0.3, -0.2, 1.5) - point;
    const double distance = glm::length(offset);
    CHECK(irradiance(scene, point) ==
          Approx(offset.z / (4 * pi * std::pow(distance, 3))).epsilon(1e-5));
  }
}

TEST_CASE(
    "a spot light has full intensity in its inner cone, none beyond its outer, all its flux") {
  Scene scene = test::plate(black, 6.0f, 1);
  Light spot = test::point_light("spot", {0, 0, 1});
  spot.kind = LightKind::spot;
  spot.inner_cone_angle = 0.3f;
  spot.outer_cone_angle = 0.6f;
  scene.lights.push_back(spot);
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
  Scene scene = test::plate(black, 2.0f, 1);
  Light sun = test::point_light("sun", {0, 0, 0});
  sun.kind = LightKind::directional;
  sun.direction = glm::normalize(glm::vec3(0.6f, 0, -0.8f));
  scene.lights.push_back(sun);
  CHECK(irradiance(scene, {0.1, 0.2, 0}) == Approx(0.8 / (pi * 2)).epsilon(1e-5));
}

TEST_CASE("an area light gives its form factor times its radiance") {
  const Scene scene = floor_under_lamp(false, false);
  for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), glm::dvec3(0.7, 0.9, 0)}) {
    const double truth = lamp_irradiance(point);
    CHECK_VERDICT(
        test::mean_is(test::path_irradiances(scene, {{point, up}}, 4000), truth, 0.02 * truth));
  }
}

TEST_CASE("a lamp gives nothing from its back, and half from each side where it has two") {
  CHECK(test::path_means(floor_under_lamp(false, true), {{{0, 0, 0}, up}}, 1, 2000)
            .irradiance.at(0) == 0);
  for (const bool turned : {false, true}) {
    const double truth = 0.5 * lamp_irradiance({0, 0, 0});
    CHECK_VERDICT(test::mean_is(
        test::path_irradiances(floor_under_lamp(true, turned), {{{0, 0, 0}, up}}, 4000), truth,
        0.02 * truth));
  }
}

TEST_CASE("a black wall hides what is behind it") {
  Scene scene = test::plate(black, 6.0f, 1);
  test::SceneBuilder builder;
  const std::uint32_t material = builder.add(black);
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, material);
  builder.grid({0.5f, -3, 0}, {0, 6, 0}, {0, 0, 1}, 1, material);
  builder.add(test::point_light("lamp", {0, 0, 1}));
  scene = builder.build();
  CHECK(irradiance(scene, {0.4, 0, 0}) > 0);
  CHECK(irradiance(scene, {1.0, 0, 0}) == 0);
}

TEST_CASE("a pane of thin glass passes what Fresnel's equations say, from lamps of every kind") {
  // Straight on: F = ((n - 1) / (n + 1))^2 at each face, (1 - F) / (1 + F) through both.
  const double fresnel = 0.04, passed = (1 - fresnel) / (1 + fresnel);
  test::SceneBuilder builder;
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, builder.add(black));
  builder.grid({-3, -3, 0.5f}, {6, 0, 0}, {0, 6, 0}, 1, builder.add(test::glass(1.5f, true)));
  Scene with_point = builder.build();
  with_point.lights.push_back(test::point_light("lamp", {0, 0, 1}));
  CHECK(irradiance(with_point, {0, 0, 0}) == Approx(passed / (4 * pi)).epsilon(1e-5));

  const std::uint32_t lamp = builder.add(test::area_light("lamp"));
  builder.grid({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, 1, 0, lamp);
  const double truth = pane_under_lamp();
  CHECK_VERDICT(test::mean_is(test::path_irradiances(builder.build(), {{{0, 0, 0}, up}}, 20'000),
                              truth, 0.02 * truth));
}

TEST_CASE("a mirror shows the lamp's image") {
  // The lamp faces up; a mirror 1 m above it shows it 2 m above where it is.
  test::SceneBuilder builder;
  const std::uint32_t floor = builder.add(black);
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, floor);
  builder.grid({-6, -6, 1}, {0, 12, 0}, {12, 0, 0}, 1, builder.add(test::mirror(glm::vec3(0.9f))));
  const std::uint32_t lamp = builder.add(test::area_light("lamp"));
  builder.grid({0.5f, -1.5f, 0.5f}, {1, 0, 0}, {0, 3, 0}, 1, floor, lamp);
  const double truth =
      0.9 / 3 * validation::rectangle_factor({0, 0, 0}, up, {0.5, -1.5, 1.5}, {1, 0, 0}, {0, 3, 0});
  CHECK_VERDICT(test::mean_is(test::path_irradiances(builder.build(), {{{0, 0, 0}, up}}, 60'000),
                              truth, 0.03 * truth));
}

TEST_CASE("each light of many is measured at its own power 1") {
  Scene scene = test::plate(black, 4.0f, 1);
  for (int i = 0; i < 3; ++i) {
    scene.lights.push_back(test::point_light("lamp " + std::to_string(i),
                                             {0, 0, static_cast<float>(1 + i)}, std::pow(10, i)));
  }
  std::vector<std::vector<double>> values(3);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto means = test::path_means(scene, {{{0, 0, 0}, up}}, seed, 20'000);
    for (std::size_t light = 0; light < 3; ++light) {
      values[light].push_back(means.irradiance[light]);
    }
  }
  for (std::size_t light = 0; light < 3; ++light) {
    const double truth = 1 / (4 * pi * std::pow(static_cast<double>(light + 1), 2));
    CHECK_VERDICT(test::mean_is(values[light], truth, 0.06 * truth));
  }
}

// Light between surfaces, by the path tracer, against closed forms.

/// A closed box of 2 x 1 x 1.5 m whose walls reflect `albedo` and all emit the radiance 1.
test::SceneBuilder glowing_box(float albedo) {
  test::SceneBuilder builder("glowing box");
  const std::uint32_t wall = builder.add(test::diffuse(glm::vec3(albedo)));
  const std::uint32_t lamp = builder.add(test::area_light("walls", pi * 2 * (2 + 3 + 1.5)));
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
void add_ball(test::SceneBuilder& builder, const glm::vec3& centre, float radius,
              const Material& look) {
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
    CHECK_VERDICT(
        test::mean_is(times(scene.lights[0].power, test::path_irradiances(scene, places, 8000)),
                      truth, 0.015 * truth));
  }
}

TEST_CASE("mirrors and glass that lose nothing leave a furnace as it is") {
  const Material look =
      GENERATE(test::mirror(glm::vec3(1.0f)), test::glass(1.5f), test::glass(1.5f, true));
  test::SceneBuilder builder = glowing_box(0.5f);
  add_ball(builder, {1, 0.5f, 0.6f}, 0.35f, look);
  const Scene scene = builder.build();
  CHECK_VERDICT(
      test::mean_is(times(scene.lights[0].power, test::path_irradiances(scene, places, 4000)),
                    2 * pi, 0.02 * 2 * pi));
}

TEST_CASE("in a closed box the mean irradiance is the flux over (1 - rho) times the area") {
  const Scene scene = test::closed_box(test::diffuse(glm::vec3(0.7f)));
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
  CHECK_VERDICT(test::mean_is(test::path_irradiances(scene, sensors, 20), truth, 0.01 * truth));
}

TEST_CASE("a glossy plate in a furnace reflects the integral of its BSDF, and receives pi L") {
  const float roughness = GENERATE(0.05f, 0.3f);
  const Material metal = test::glossy(glm::vec3(0.2f), glm::vec3(0.6f), roughness);
  test::SceneBuilder builder = glowing_box(0.0f);
  const std::uint32_t plate = builder.add(metal);
  builder.quad({0.8f, 0.3f, 0.7f}, {1.2f, 0.3f, 0.7f}, {1.2f, 0.7f, 0.7f}, {0.8f, 0.7f, 0.7f},
               plate);
  const Scene scene = builder.build();
  // Seen from straight above, by quadrature of the lobe and of the base below it.
  const double truth = validation::glossy_reflectance(0.2, 0.6, double{roughness});
  std::vector<double> irradiance, radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const auto means = test::path_means(scene, {{{1, 0.5, 0.7}, {0, 0, 1}}}, seed, 40'000);
    irradiance.push_back(scene.lights[0].power * means.irradiance[0]);
    radiance.push_back(scene.lights[0].power * means.radiance[0]);
  }
  CHECK_VERDICT(test::mean_is(irradiance, pi, 0.02 * pi));
  CHECK_VERDICT(test::mean_is(radiance, truth, 0.02 * truth));
}

// Every material by photon maps and by paths: the same picture.

/// Mean radiance of a layer over the picture, green.
double mean_radiance(const LightLayers& layers) {
  double sum = 0;
  for (const glm::vec3& radiance : layers.layers[0].radiance) sum += double{radiance.g};
  return sum / static_cast<double>(layers.layers[0].radiance.size());
}

/// One texel over every triangle, whose coordinates run along two of its edges.
void cover(Scene& scene, std::array<std::uint8_t, 4> texel) {
  scene.textures.emplace_back("texel", 1, 1, std::vector<std::array<std::uint8_t, 4>>{texel});
  scene.corner_uv.assign(scene.triangle_count(),
                         {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)});
}

/// A room with a lamp at z = 0.7, its walls of the first material.
Scene room(const Material& walls) { return test::closed_box(walls, 2); }

/// The room with a plate of the material between lamp and floor.
Scene room_with_plate(const Material& plate) {
  test::SceneBuilder builder("room with a plate");
  builder.box(glm::vec3(0.0f), glm::vec3(1.0f), builder.add(test::diffuse(glm::vec3(0.6f))), true,
              2);
  builder.grid({0, 0, 0.3f}, {1, 0, 0}, {0, 1, 0}, 2, builder.add(plate));
  builder.add(test::point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

/// Looks down at the floor, away from its edges by more than the estimates reach; paths and photons
/// see as much light, within 4%.
void check_agreement(const Scene& scene) {
  const Camera camera =
      Camera::look_at({0.5, 0.5, 0.9}, {0.5, 0.5, 0}, {0, 1, 0}, 2 * std::atan(0.3 / 0.9));
  std::vector<double> differences;
  double mean = 0;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters;
    parameters.film.width = parameters.film.height = 16;
    parameters.film.samples_per_pixel = 36;
    parameters.seed = seed;
    parameters.photons.emitted_photons = 200'000;
    parameters.radius = 0.1;
    const double photons = mean_radiance(render(scene, camera, test::device(), parameters).layers);
    const double paths = mean_radiance(trace_paths(scene, camera, eye_rays(parameters)).layers);
    differences.push_back(photons - paths);
    mean += paths / 16;
  }
  CHECK_VERDICT(test::mean_is(differences, 0.0, 0.04 * mean));
}

TEST_CASE("paths and photon maps agree on a coated wall") {
  check_agreement(room(test::glossy(glm::vec3(0.5f), glm::vec3(0.04f), 0.4f)));
}

TEST_CASE("paths and photon maps agree on a rough metal", "[slow]") {
  check_agreement(room(test::glossy(glm::vec3(0.0f), glm::vec3(0.7f), 0.6f)));
}

TEST_CASE("paths and photon maps agree under a normal map", "[slow]") {
  const auto [albedo, specular] =
      GENERATE(std::pair(0.6f, 0.0f), std::pair(0.5f, 0.04f), std::pair(0.0f, 0.7f));
  const Material walls = test::glossy(glm::vec3(albedo), glm::vec3(specular), 0.5f);
  Scene scene = room(walls);
  cover(scene, {145, 112, 253, 255});
  scene.materials[0].normal_texture = 0;
  CAPTURE(albedo, specular);
  check_agreement(scene);
}

TEST_CASE("paths and photon maps agree through holes", "[slow]") {
  Material plate = test::diffuse(glm::vec3(0.4f));
  plate.opacity = GENERATE(0.0f, 0.4f);
  CAPTURE(plate.opacity);
  check_agreement(room_with_plate(plate));
}

// What the path tracer sees of surfaces whose vertex normals bend, against closed forms.

constexpr double sun_lux = 1000, albedo = 0.6;
const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.4, -0.5, 0.7));

Scene sphere_in_sun(const SmoothMesh& sphere, bool with_normals = true) {
  SceneBuilder builder;
  sphere.add_to(builder, builder.add(diffuse(glm::vec3(albedo))), with_normals);
  Light sun = point_light("sun", {});
  sun.kind = LightKind::directional;
  sun.direction = glm::vec3(-to_sun);
  builder.add_distant(sun, sun_lux);
  return builder.build();
}

/// The light that arrives at one sensor by so many paths, at the light's power.
PathMeans seen(const Scene& scene, const Sensor& sensor, std::size_t paths) {
  PathMeans means = path_means(scene, {sensor}, 1, paths);
  means.irradiance[0] *= scene.lights[0].power;
  if (!means.radiance.empty()) means.radiance[0] *= scene.lights[0].power;
  return means;
}

TEST_CASE("The eye sees the sun on a sphere of facets by the cosine to the interpolated normal") {
  const SmoothMesh sphere = smooth_sphere(glm::dvec3(0.0), 0.5);
  const Scene scene = sphere_in_sun(sphere);
  REQUIRE(needs_of(scene).smooth_shading);
  for (const SmoothMesh::Place& place : sphere.places()) {
    const double facet = glm::dot(place.sensor.normal, to_sun);
    const double smooth = glm::dot(place.smooth, to_sun);
    CAPTURE(facet, smooth);
    const PathMeans light = seen(scene, place.sensor, 1);
    // Lux is that of the facet, and what is below it is not seen.
    CHECK(light.irradiance.at(0) == Approx(sun_lux * std::max(0.0, facet)).margin(0.05));
    CHECK(light.radiance.at(0) ==
          Approx(facet > 0 ? albedo / pi * sun_lux * std::max(0.0, smooth) : 0.0).margin(0.05));
  }
}

TEST_CASE("Without vertex normals, or with those of its triangles, nothing is shaded smoothly") {
  const SmoothMesh sphere = smooth_sphere(glm::dvec3(0.0), 0.5);
  CHECK_FALSE(needs_of(sphere_in_sun(sphere, false)).smooth_shading);
  SmoothMesh flat;
  for (const glm::uvec3& triangle : sphere.triangles) {
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    for (int i = 0; i < 3; ++i) flat.vertices.push_back(sphere.vertices[triangle[i]]);
    const auto corner = flat.vertices.end() - 3;
    flat.normals.insert(flat.normals.end(), 3,
                        glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0])));
    flat.triangles.emplace_back(first, first + 1, first + 2);
  }
  const Scene scene = sphere_in_sun(flat);
  CHECK_FALSE(needs_of(scene).smooth_shading);
  CHECK(scene.corner_normal.empty());
}

TEST_CASE("Under an even sky a turned normal sees (1 + cosine) / 2 of it") {
  // A ring of few facets, whose normals are far from the round ones near its edges.
  const SmoothMesh ring = smooth_cylinder(glm::dvec3(0.0), 0.5, 1.0, 6);
  SceneBuilder builder;
  ring.add_to(builder, builder.add(diffuse(glm::vec3(albedo))));
  builder.add_surroundings("sky", EnvironmentMap("sky", 2, 1, std::vector(2, glm::vec3(1.0f))));
  const Scene scene = builder.build();
  const SmoothMesh::Place place = ring.places({0.9, 0.07, 0.03}).front();
  const double cosine = glm::dot(place.sensor.normal, place.smooth);
  REQUIRE(cosine < 0.95);
  const PathMeans light = seen(scene, place.sensor, 20'000);
  CHECK(light.radiance.at(0) / light.irradiance.at(0) ==
        Approx(albedo / pi * (1 + cosine) / 2).epsilon(0.01));
}

}  // namespace
}  // namespace photile::test
