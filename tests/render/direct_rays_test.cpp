// Light straight from lamps by rays, the rest by photons: --set direct_rays=1.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "photile/errors.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

RenderParameters by_rays(int light_samples, std::uint64_t seed = 1) {
  RenderParameters parameters;
  parameters.direct_rays = light_samples;
  parameters.film.width = parameters.film.height = 1;
  parameters.film.samples_per_pixel = 1;
  parameters.photons.emitted_photons = 100'000;
  parameters.seed = seed;
  return parameters;
}

std::uint64_t stored(const Scene& scene, bool direct) {
  const RayScene rays(scene);
  PhotonTracerParameters parameters;
  parameters.emitted_photons = 10'000;
  parameters.store_direct = direct;
  return trace_photons(rays, parameters).photons.size();
}

/// Means over a picture of each layer.
struct Means {
  std::vector<double> illuminance, radiance;

  explicit Means(const LightLayers& layers) {
    for (const LightLayers::Layer& layer : layers.layers) {
      double lux = 0, reflected = 0;
      for (const float value : layer.illuminance) lux += value;
      for (const glm::vec3& value : layer.radiance) reflected += luminance(value);
      illuminance.push_back(lux / static_cast<double>(layer.illuminance.size()));
      radiance.push_back(reflected / static_cast<double>(layer.radiance.size()));
    }
  }
};

/// Whether rays and photons together see what paths see, in both layers of a furnished room whose
/// floor is of a material.
void check_room(const Material& floor, double delta) {
  Scene scene = test::furnished_room();
  scene.materials[0] = floor;
  const Camera camera = test::above(2.6, 2.2, 2.0, 0.4);
  std::vector<std::vector<double>> differences(4);
  Means truth{LightLayers()};
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = by_rays(2, seed);
    parameters.film.width = parameters.film.height = 8;
    parameters.film.samples_per_pixel = 64;
    parameters.photons.emitted_photons = 400'000;
    parameters.radius = 0.15;
    const Means own(render(scene, camera, test::device(), parameters).layers);
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 1024;
    truth = Means(trace_paths(scene, camera, film).layers);
    for (std::size_t layer = 0; layer < 2; ++layer) {
      differences[2 * layer].push_back(own.illuminance[layer] / truth.illuminance[layer] - 1);
      differences[2 * layer + 1].push_back(own.radiance[layer] / truth.radiance[layer] - 1);
    }
  }
  for (const std::vector<double>& difference : differences) {
    CHECK_VERDICT(test::mean_is(difference, 0.0, delta));
  }
}

}  // namespace

TEST_CASE("direct rays: a point light gives its closed form without noise, and stores no photon") {
  constexpr float albedo = 0.6f;
  Scene scene = test::plate(test::diffuse(glm::vec3(albedo)), 4.0f, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1.5f}));
  for (const double x : {0.0, 0.7, 1.6}) {
    const RenderResult result =
        render(scene, test::above(x, 0.2, 1, 1e-4), test::device(), by_rays(1));
    const double squared = x * x + 0.2 * 0.2 + 1.5 * 1.5;
    const double truth = 1.5 / (4 * pi * squared * std::sqrt(squared));
    CHECK(result.stored_photons == 0);
    CHECK(result.layers.layers[0].illuminance[0] == Approx(truth).epsilon(1e-3));
    CHECK(result.layers.layers[0].radiance[0].g == Approx(albedo / pi * truth).epsilon(1e-3));
  }
}

TEST_CASE("direct rays: close to a large lamp both techniques add up to its form factor") {
  test::SceneBuilder builder;
  const std::uint32_t black = builder.add(test::diffuse(glm::vec3(0.0f)));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, black);
  builder.grid({-1, -1, 0.5f}, {0, 2, 0}, {2, 0, 0}, 1, black,
               builder.add(test::area_light("lamp")));
  const Scene scene = builder.build();
  const glm::dvec3 point(0.3, 0.2, 0);
  const double truth =
      validation::rectangle_factor(point, {0, 0, 1}, {-1, -1, 0.5}, {0, 2, 0}, {2, 0, 0}) / 4;
  std::vector<double> lux;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = by_rays(4000, seed);
    parameters.film.samples_per_pixel = 4;
    const RenderResult result =
        render(scene, test::above(point.x, point.y, 0.4, 1e-4), test::device(), parameters);
    CHECK(result.stored_photons == 0);
    lux.push_back(result.layers.layers[0].illuminance[0]);
  }
  CHECK_VERDICT(test::mean_is(lux, truth, 0.02 * truth));
}

TEST_CASE("direct rays: in a closed box each path's first photon is left out, and no other") {
  const Scene scene = test::closed_box(test::diffuse(glm::vec3(0.5f)));
  CHECK(stored(scene, true) - stored(scene, false) == 10'000);
}

TEST_CASE("direct rays: light through a pane counts as direct, light by a mirror does not") {
  test::SceneBuilder builder;
  const std::uint32_t black = builder.add(test::diffuse(glm::vec3(0.0f)));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, black);
  builder.add(test::point_light("lamp", {0, 0, 1}));
  SECTION("a pane") {
    builder.grid({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(test::glass(1.5f, true)));
    CHECK(stored(builder.build(), false) == 0);
  }
  SECTION("a mirror on the ceiling doubles the lamp at its image, three metres up") {
    builder.grid({-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, 1, builder.add(test::mirror({1, 1, 1})));
    const Scene scene = builder.build();
    const double direct = 1 / (4 * pi), image = 1 / (4 * pi * 9);
    std::vector<double> lux;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      RenderParameters parameters = by_rays(1, seed);
      parameters.film.width = parameters.film.height = 16;
      parameters.photons.emitted_photons = 400'000;
      const RenderResult result =
          render(scene, test::above(0, 0, 0.5, 0.2), test::device(), parameters);
      lux.push_back(Means(result.layers).illuminance[0]);
    }
    // Over the square the cosine and distance of either lamp change their light by under 1%.
    CHECK_VERDICT(test::mean_is(lux, direct + image, 0.03 * (direct + image)));
  }
}

TEST_CASE("direct rays: with photons they see what paths see on a glossy floor", "[long][slow]") {
  check_room(test::glossy(glm::vec3(0.4f), glm::vec3(0.3f), 0.3f), 0.06);
}

TEST_CASE("direct rays: layers are the same whatever the powers") {
  Scene scene = test::furnished_room();
  RenderParameters parameters = by_rays(2);
  parameters.photons.quota = PhotonQuota::equal;
  parameters.film.width = parameters.film.height = 8;
  // Half of the looks go by power: with one lamp the choice does not depend on it.
  scene.lights.pop_back();
  const LightLayers dim =
      render(scene, test::above(2.6, 2.2, 2.0, 0.4), test::device(), parameters).layers;
  scene.lights[0].power *= 1000;
  const LightLayers bright =
      render(scene, test::above(2.6, 2.2, 2.0, 0.4), test::device(), parameters).layers;
  CHECK(dim.layers[0].radiance == bright.layers[0].radiance);
  CHECK(dim.layers[0].illuminance == bright.layers[0].illuminance);
}

TEST_CASE("direct rays: paths find direct light themselves") {
  const Scene scene = test::furnished_room();
  PrimaryHitParameters film = eye_rays(by_rays(2));
  const Means with(trace_paths(scene, test::above(2.6, 2.2, 2.0, 0.4), film).layers);
  film.direct_rays = 0;
  CHECK(with.radiance ==
        Means(trace_paths(scene, test::above(2.6, 2.2, 2.0, 0.4), film).layers).radiance);
}

TEST_CASE("direct rays: more light samples than the limit are refused") {
  Scene scene = test::closed_box(test::diffuse(glm::vec3(0.5f)));
  CHECK_THROWS_AS(
      render(scene, test::above(0.5, 0.5, 0.5, 0.1), test::device(), by_rays(1'000'000)),
      UsageError);
}

}  // namespace photile::test
