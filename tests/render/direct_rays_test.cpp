// Light straight from lamps by rays, the rest by photons: --set direct_rays=1.
#include <numbers>

#include "photile/errors.hpp"
#include "photile/photons.hpp"
#include "pictures.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

RenderParameters by_rays(int light_samples, std::uint64_t seed = 1) {
  RenderParameters parameters = small_picture(100'000, 1, 1, 1);
  parameters.direct_rays = light_samples;
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

}  // namespace

TEST_CASE("direct rays: a point light gives its closed form without noise, and stores no photon") {
  constexpr float albedo = 0.6f;
  Scene scene = plate(diffuse(albedo), 4.0f, 3);
  scene.lights.push_back(point_light("lamp", {0, 0, 1.5f}));
  for (const double x : {0.0, 0.7, 1.6}) {
    const RenderResult result = render(scene, above(x, 0.2, 1, 1e-4), device(), by_rays(1));
    const double squared = x * x + 0.2 * 0.2 + 1.5 * 1.5;
    const double truth = 1.5 / (4 * pi * squared * std::sqrt(squared));
    CHECK(result.stored_photons == 0);
    CHECK(result.layers.layers[0].illuminance[0] == Approx(truth).epsilon(1e-3));
    CHECK(result.layers.layers[0].radiance[0].g == Approx(albedo / pi * truth).epsilon(1e-3));
  }
}

TEST_CASE("direct rays: close to a large lamp both techniques add up to its form factor") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, black);
  builder.grid({-1, -1, 0.5f}, {0, 2, 0}, {2, 0, 0}, 1, black, builder.add(area_light("lamp")));
  const Scene scene = builder.build();
  const glm::dvec3 point(0.3, 0.2, 0);
  const double truth =
      validation::rectangle_factor(point, {0, 0, 1}, {-1, -1, 0.5}, {0, 2, 0}, {2, 0, 0}) / 4;
  const std::vector<double> lux = of_seeds([&](std::uint64_t seed) {
    RenderParameters parameters = by_rays(4000, seed);
    parameters.film.samples_per_pixel = 4;
    const RenderResult result =
        render(scene, above(point.x, point.y, 0.4, 1e-4), device(), parameters);
    CHECK(result.stored_photons == 0);
    return result.layers.layers[0].illuminance[0];
  });
  CHECK_VERDICT(mean_is(lux, truth, 0.02 * truth));
}

TEST_CASE("direct rays: in a closed box each path's first photon is left out, and no other") {
  const Scene scene = closed_box(diffuse(0.5f));
  CHECK(stored(scene, true) - stored(scene, false) == 10'000);
}

TEST_CASE("direct rays: light through a pane counts as direct, light by a mirror does not") {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 1, black);
  builder.add(point_light("lamp", {0, 0, 1}));
  SECTION("a pane") {
    builder.grid({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(glass(1.5f, true)));
    CHECK(stored(builder.build(), false) == 0);
  }
  SECTION("a mirror on the ceiling doubles the lamp at its image, three metres up") {
    builder.grid({-9, -9, 2}, {0, 18, 0}, {18, 0, 0}, 1, builder.add(mirror({1, 1, 1})));
    const Scene scene = builder.build();
    const double direct = 1 / (4 * pi), image = 1 / (4 * pi * 9);
    const std::vector<double> lux = of_seeds([&](std::uint64_t seed) {
      RenderParameters parameters = by_rays(1, seed);
      parameters.film.width = parameters.film.height = 16;
      parameters.photons.emitted_photons = 400'000;
      const RenderResult result = render(scene, above(0, 0, 0.5, 0.2), device(), parameters);
      return LayerMeans(result.layers.layers[0]).illuminance;
    });
    // Over the square the cosine and distance of either lamp change their light by under 1%.
    CHECK_VERDICT(mean_is(lux, direct + image, 0.03 * (direct + image)));
  }
}

TEST_CASE("direct rays: with photons they see what paths see on a glossy floor", "[long][slow]") {
  RenderParameters parameters = small_picture(400'000, 8, 8, 64);
  parameters.direct_rays = 2;
  parameters.radius = 0.15;
  check_room(furnished_room(), glossy(0.4f, 0.3f, 0.3f), parameters, 0.06);
}

TEST_CASE("direct rays: layers are the same whatever the powers") {
  Scene scene = furnished_room();
  RenderParameters parameters = by_rays(2);
  parameters.photons.quota = PhotonQuota::equal;
  parameters.film.width = parameters.film.height = 8;
  // Half of the looks go by power: with one lamp the choice does not depend on it.
  scene.lights.pop_back();
  const LightLayers dim = render(scene, above(2.6, 2.2, 2.0, 0.4), device(), parameters).layers;
  scene.lights[0].power *= 1000;
  const LightLayers bright = render(scene, above(2.6, 2.2, 2.0, 0.4), device(), parameters).layers;
  CHECK(dim.layers[0].radiance == bright.layers[0].radiance);
  CHECK(dim.layers[0].illuminance == bright.layers[0].illuminance);
}

TEST_CASE("direct rays: paths find direct light themselves") {
  const Scene scene = furnished_room();
  PrimaryHitParameters film = eye_rays(by_rays(2));
  const Camera camera = above(2.6, 2.2, 2.0, 0.4);
  const LightLayers with = trace_paths(scene, camera, film).layers;
  film.direct_rays = 0;
  CHECK(same_bits(with, trace_paths(scene, camera, film).layers));
}

TEST_CASE("direct rays: more light samples than the limit are refused") {
  Scene scene = closed_box(diffuse(0.5f));
  CHECK_THROWS_AS(render(scene, above(0.5, 0.5, 0.5, 0.1), device(), by_rays(1'000'000)),
                  UsageError);
}

}  // namespace photile::test
