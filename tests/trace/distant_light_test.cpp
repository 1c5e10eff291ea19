// Environments and suns with a disc: where directions and photons fall, what paths and eyes see.
#include "trace/distant_light.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "path_irradiance.hpp"
#include "photile/photons.hpp"
#include "suns.hpp"

namespace photile::test {

using namespace trace;

namespace {

using std::numbers::pi;
const glm::dvec3 up(0, 0, 1);  // of the plates; a map's zenith is y

Scene with_environment(Scene scene, const EnvironmentMap& map) {
  add_environment(scene, map);
  return scene;
}

EnvironmentMap even_map(const glm::vec3& radiance) {
  return {"even", 6, 3, std::vector<glm::vec3>(18, radiance)};
}

/// Bright towards +z: the columns whose azimuths point there.
EnvironmentMap half_bright_map() {
  std::vector<glm::vec3> texels;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 8; ++column)
      texels.emplace_back(column < 2 || column > 5 ? 3.0f : 0.0f);
  return {"half", 8, 5, texels};
}

Scene with_sun(Scene scene, const glm::vec3& towards, float diameter) {
  scene.lights.push_back(sun_along(-glm::normalize(towards), diameter));
  return scene;
}

/// Two plates of 2 x 2 m at a right angle, with `material`.
Scene corner(const Material& material) {
  SceneBuilder builder("corner");
  const std::uint32_t index = builder.add(material);
  builder.grid({0, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, index);
  builder.grid({0, -1, 0}, {0, 2, 0}, {0, 0, 2}, 1, index);
  return builder.build();
}

/// Luminous flux that reaches the upper side of triangles that face up, of the light's 1 lm.
double flux_from_above(const Scene& scene, std::uint64_t seed, std::uint64_t paths) {
  const Photons photons =
      trace_photons(RayScene(scene), {.emitted_photons = paths, .seed = seed}).photons;
  double flux = 0;
  for (std::size_t i = 0; i < photons.size(); ++i)
    if (face_normal(scene, photons.oriented_face[i]).z > 0.5) flux += luminance(photons.flux[i]);
  return flux;
}

std::vector<double> fluxes_from_above(const Scene& scene, std::uint64_t paths) {
  return of_seeds([&](std::uint64_t seed) { return flux_from_above(scene, seed, paths); });
}

double disc_of(const Scene& scene) { return pi * std::pow(bounding_sphere(scene).radius, 2); }

}  // namespace

TEST_CASE("directions towards an environment fall into texels by luminance times solid angle",
          "[environment]") {
  std::vector<glm::vec3> texels;
  for (int i = 0; i < 8 * 5; ++i) texels.emplace_back(i % 3, (i * 7) % 5, i % 3 == 0 ? 0 : 40);
  const EnvironmentMap map("map", 8, 5, texels, 30);
  const EnvironmentSampler sampler(map);
  constexpr int trials = 200'000;
  std::vector<double> counts(texels.size(), 0.0), expected;
  for (int i = 0; i < trials; ++i) {
    const auto drawn = sampler.sample(
        RandomStream(5, static_cast<std::uint64_t>(i), 0).block(Purpose::emission, 0));
    const std::size_t texel = map.texel_towards(drawn.direction);
    ++counts[texel];
    REQUIRE(luminance(drawn.color) == Approx(1));
    REQUIRE(drawn.density == Approx(sampler.density(drawn.direction)));
  }
  double density = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const int row = static_cast<int>(i) / 8;
    expected.push_back(trials * luminance(texels[i]) * map.solid_angle(row) /
                       luminance(map.integral()));
    density += map.solid_angle(row) * double{sampler.density(glm::vec3(map.direction_at(
                                          static_cast<int>(i) % 8 + 0.5, row, 0.5)))};
  }
  CHECK(density == Approx(1).epsilon(1e-5));
  for (std::size_t i = expected.size(); i-- > 0;) {
    if (expected[i] > 0) continue;
    REQUIRE(counts[i] == 0);
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(i));
    counts.erase(counts.begin() + static_cast<std::ptrdiff_t>(i));
  }
  CHECK_VERDICT(counts_agree(counts, expected));
}

TEST_CASE("within a texel directions are even over the solid angle", "[environment]") {
  const EnvironmentMap map("one", 1, 1, {glm::vec3(1.0f)});
  const EnvironmentSampler sampler(map);
  std::vector<double> counts(100, 0.0);
  constexpr int trials = 100'000;
  for (int i = 0; i < trials; ++i) {
    const glm::dvec3 d(
        sampler
            .sample(RandomStream(6, static_cast<std::uint64_t>(i), 0).block(Purpose::emission, 0))
            .direction);
    const int height = std::clamp(static_cast<int>(5 * (d.y + 1)), 0, 9);
    const int turn = std::clamp(static_cast<int>(5 * (std::atan2(d.x, d.z) / pi + 1)), 0, 9);
    ++counts[static_cast<std::size_t>(10 * height + turn)];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(100, trials / 100.0)));
}

TEST_CASE("directions towards a sun are even over its disc", "[sun]") {
  const float diameter = GENERATE(0.0093f, 1.0f);
  const Scene scene = with_sun(plate(diffuse({}), 1), {1, 2, 3}, diameter);
  const DistantSampler sampler(scene, scene.lights[0]);
  const glm::dvec3 centre(-scene.lights[0].direction);
  std::vector<double> counts(20, 0.0);
  constexpr int trials = 100'000;
  const double widest = 2 * std::pow(std::sin(0.25 * diameter), 2);  // 1 - cosine
  for (int i = 0; i < trials; ++i) {
    const auto drawn = sampler.sample(
        RandomStream(7, static_cast<std::uint64_t>(i), 0).block(Purpose::emission, 0));
    const double sine = glm::length(glm::cross(centre, glm::dvec3(drawn.direction)));
    const double from_centre = 2 * std::pow(std::sin(0.5 * std::asin(sine)), 2);
    ++counts[std::min<std::size_t>(static_cast<std::size_t>(20 * from_centre / widest), 19)];
    REQUIRE(double{drawn.density} * disc_solid_angle(scene.lights[0]) == Approx(1));
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(20, trials / 20.0)));
}

TEST_CASE("of many suns all that shine from a direction are found, at the poles of the sphere, too",
          "[sun]") {
  Scene scene = plate(diffuse({}), 1);
  for (const glm::vec3& towards : std::initializer_list<glm::vec3>{{0, 1, 0},
                                                                   {0, -1, 0},
                                                                   {0.02f, 1, 0.01f},
                                                                   {1, 0, 0},
                                                                   {-1, 0, 0},
                                                                   {0, 0, 1},
                                                                   {0, 0, -1}}) {
    scene = with_sun(scene, towards, 0.03f);
    scene.lights.back().name += std::to_string(scene.lights.size());
  }
  const DistantLights lights(scene);
  int looked_for = 0;
  for (const Light& sun : scene.lights) {
    const DistantSampler sampler(scene, sun);
    for (std::uint64_t i = 0; i < 100; ++i) {
      const glm::vec3 direction =
          sampler.sample(RandomStream(8, i, 0).block(Purpose::emission, 0)).direction;
      const auto found = lights.towards(direction);
      for (std::uint32_t index = 0; index < scene.lights.size(); ++index) {
        if (lights[index].radiance(direction) == glm::vec3(0.0f)) continue;
        ++looked_for;
        CAPTURE(sun.name, index);
        REQUIRE(std::count(found.begin(), found.end(), index) == 1);
      }
    }
  }
  CHECK(looked_for >= 700);  // each of seven suns where it was sampled
}

TEST_CASE("photons of an even environment land evenly on both sides of a plate, pi L on each",
          "[environment]") {
  const Scene scene = with_environment(plate(diffuse({}), 2), even_map(glm::vec3(5.0f)));
  constexpr std::uint64_t paths = 200'000;
  const Photons photons =
      trace_photons(RayScene(scene), {.emitted_photons = paths, .seed = 2}).photons;
  std::vector<double> counts(33, 0.0);
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::vec3 p = 2.0f * (photons.position[i] + 1.0f);
    const int cell =
        4 * std::clamp(static_cast<int>(p.y), 0, 3) + std::clamp(static_cast<int>(p.x), 0, 3);
    const bool top = face_normal(scene, photons.oriented_face[i]).z > 0;
    ++counts[static_cast<std::size_t>(cell + (top ? 16 : 0))];
  }
  counts.back() = static_cast<double>(paths - photons.size());
  // pi L times a cell of 1/4 m2, of 4 pi L times the disc.
  const double cell = paths * 0.25 / (4 * disc_of(scene));
  std::vector<double> expected(33, cell);
  expected.back() = paths - 32 * cell;
  CHECK_VERDICT(counts_agree(counts, expected));
}

TEST_CASE("photons of a half bright environment reach the side that faces it", "[environment]") {
  const Scene scene = with_environment(plate(diffuse({}), 2), half_bright_map());
  const double above = flux_from_above(scene, 1, 100'000);
  const Scene even = with_environment(plate(diffuse({}), 2), even_map(glm::vec3(3.0f)));
  // The top receives the same pi L, of half the power.
  CHECK(above == Approx(2 * flux_from_above(even, 1, 100'000)).epsilon(0.02));
  CHECK_VERDICT(mean_is(fluxes_from_above(scene, 20'000), 4 / (2 * disc_of(scene)), 0.02));
}

TEST_CASE("paths of an even environment give pi L, of a half bright one pi L or nothing",
          "[environment]") {
  const Scene even = with_environment(plate(diffuse({}), 2), even_map(glm::vec3(5.0f)));
  const double one = 1 / (4 * disc_of(even));
  CHECK_VERDICT(mean_is(path_irradiances(even, {{{0.3, 0.2, 0}, up}}, 2000), one, 0.05 * one));
  const Scene half = with_environment(plate(diffuse({}), 2), half_bright_map());
  CHECK_VERDICT(
      mean_is(path_irradiances(half, {{{0.3, 0.2, 0}, up}}, 2000), 2 * one, 0.05 * 2 * one));
  CHECK(path_means(half, {{{0.3, 0.2, 0}, -up}}, 1, 2000).irradiance.at(0) == 0);
}

TEST_CASE("in an even environment a white corner vanishes: pi L everywhere", "[environment]") {
  const Scene scene = with_environment(corner(diffuse(1.0f)), even_map({1, 3, 2}));
  const double one = 1 / (4 * disc_of(scene));
  for (const double near : {0.02, 1.0}) {
    CAPTURE(near);
    CHECK_VERDICT(mean_is(path_irradiances(scene, {{{near, 0, 0}, up}}, 4000), one, 0.05 * one));
  }
  CHECK_VERDICT(mean_is(fluxes_from_above(scene, 40'000), 4 * one, 0.05 * 4 * one));
}

TEST_CASE("an environment behind a pane is dimmed by Fresnel's equations for paths and photons",
          "[environment]") {
  // The truth by the midpoint rule over the hemisphere, with both faces of the pane.
  double passed = 0;
  constexpr int steps = 20'000;
  for (int i = 0; i < steps; ++i) {
    const double theta = 0.5 * pi * (i + 0.5) / steps, inside = std::asin(std::sin(theta) / 1.5);
    const double s = std::sin(theta - inside) / std::sin(theta + inside);
    const double p = std::tan(theta - inside) / std::tan(theta + inside);
    const double fresnel = 0.5 * (s * s + p * p);
    passed +=
        (1 - fresnel) / (1 + fresnel) * 2 * std::sin(theta) * std::cos(theta) * 0.5 * pi / steps;
  }
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse({})), pane = builder.add(glass(1.5f, true));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, black);
  builder.grid({-50, -50, 0.01f}, {100, 0, 0}, {0, 100, 0}, 1, pane);
  const Scene scene = with_environment(builder.build(), even_map(glm::vec3(1.0f)));
  const double truth = passed / (4 * disc_of(scene));
  CHECK_VERDICT(mean_is(path_irradiances(scene, {{{0, 0, 0}, up}}, 4000), truth, 0.05 * truth));
}

TEST_CASE("a sun gives E cos by paths and photons, also through a pane", "[sun]") {
  const float diameter = GENERATE(0.0093f, 0.7f);
  const glm::vec3 towards = glm::normalize(glm::vec3(1, 0, 1));
  const Scene scene = with_sun(plate(diffuse({}), 2), towards, diameter);
  // E facing it is L pi sin^2, and 1 lm is L times its solid angle times the disc. The whole disc
  // is above the horizon.
  const double half = 0.5 * double{diameter};
  const double facing =
      pi * std::pow(std::sin(half), 2) / (disc_solid_angle(scene.lights[0]) * disc_of(scene));
  const double truth = facing * std::sqrt(0.5);
  CHECK_VERDICT(mean_is(path_irradiances(scene, {{{0.3, 0.2, 0}, up}}, 2000), truth, 0.05 * truth));
  CHECK_VERDICT(mean_is(fluxes_from_above(scene, 20'000), 4 * truth, 0.05 * 4 * truth));

  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse({})), pane = builder.add(glass(1.5f, true));
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, black);
  builder.grid({-5, -5, 0.5f}, {10, 0, 0}, {0, 10, 0}, 1, pane);
  const Scene glazed = with_sun(builder.build(), {0, 0, 1}, 0.0093f);
  const double passed = 0.96 / 1.04 / disc_of(glazed);  // F = 0.04 at each face
  // All paths see nearly the same.
  CHECK(path_means(glazed, {{{0, 0, 0}, up}}, 1, 1000).irradiance.at(0) ==
        Approx(passed).epsilon(1e-4));
}

TEST_CASE("eyes see an environment and a sun directly and in a mirror", "[environment]") {
  const glm::vec3 blue(1, 2, 4);
  Scene scene = with_environment(plate(mirror(0.5f), 20), even_map(blue));
  scene = with_sun(scene, {0, 0, 1}, 0.5f);
  const RayScene rays(scene);
  const PrimaryHitParameters film{.width = 1, .height = 1, .samples_per_pixel = 1};
  const auto seen = [&](const glm::dvec3& eye, const glm::dvec3& target) {
    const Camera camera = Camera::look_at(eye, target, {1, 0, 0}, 0.001);
    const PrimaryHitBatch batch = trace_primary_hits(rays, camera, film, 0, 1);
    std::array<glm::dvec3, 2> radiance{glm::dvec3(0.0), glm::dvec3(0.0)};
    for (const VisibleEmission& emission : batch.emission)
      radiance[emission.light] +=
          glm::dvec3(emission.radiance) * scene.lights[emission.light].power;
    return radiance;
  };
  const double disc = 1 / (disc_solid_angle(scene.lights[1]) * disc_of(scene));
  const auto sideways = seen({0, 0, 1}, {1, 0, 1.5});
  CHECK(glm::distance(sideways[0], glm::dvec3(blue)) < 1e-4);
  CHECK(sideways[1] == glm::dvec3(0.0));
  const auto above = seen({0, 0, 1}, {0.1, 0, 2});
  CHECK(glm::distance(above[0], glm::dvec3(blue)) < 1e-4);
  CHECK(above[1].g == Approx(disc).epsilon(1e-5));
  const auto mirrored = seen({0, 0, 1}, {0.1, 0, 0});
  CHECK(glm::distance(mirrored[0], 0.5 * glm::dvec3(blue)) < 1e-4);
  CHECK(mirrored[1].g == Approx(0.5 * disc).epsilon(1e-5));
}

}  // namespace photile::test
