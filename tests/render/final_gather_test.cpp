// Light from other surfaces gathered by rays, caustics by photons: --final-gather.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "photile/errors.hpp"
#include "photile/path_tracer.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "photile/sensors.hpp"
#include "pictures.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "tools/validation/form_factors.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

RenderParameters gathering(int rays, std::uint64_t photons, std::uint64_t seed = 1) {
  RenderParameters parameters;
  parameters.final_gather_rays = rays;
  parameters.film.width = parameters.film.height = 8;
  parameters.film.samples_per_pixel = 4;
  parameters.photons.emitted_photons = photons;
  parameters.seed = seed;
  return parameters;
}

/// A closed cube of one metre whose walls all emit and reflect, the same everywhere. The wall at
/// x = 1 can be a mirror, in which they go on.
Scene furnace(double albedo, bool has_mirror) {
  Scene scene = test::closed_box(test::diffuse(glm::vec3(static_cast<float>(albedo))));
  scene.materials.push_back(test::mirror(glm::vec3(1.0f)));
  scene.lights = {test::area_light("walls")};
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto [a, b, c] = scene.corners(t);
    if (has_mirror && std::min({a.x, b.x, c.x}) == 1.0f) {
      scene.triangle_material[t] = 1;
      continue;
    }
    scene.triangle_light[t] = 0;
    scene.lights[0].triangles.push_back(t);
  }
  return scene;
}

/// Whether both layers of a furnished room with a floor of this material are those of the path
/// tracer, in the mean over a place beside a block.
void check_gathered_room(const Material& floor, double delta) {
  Scene scene = test::furnished_room();
  scene.materials[0] = floor;
  const Camera camera = test::above(2.6, 2.2, 2.0, 0.4);
  std::vector<std::vector<double>> differences(4);
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = gathering(8, 50'000, seed);
    parameters.film.samples_per_pixel = 16;
    parameters.direct_rays = 2;
    const LightLayers own = render(scene, camera, test::device(), parameters).layers;
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 256;
    const LightLayers paths = trace_paths(scene, camera, film).layers;
    for (std::size_t layer = 0; layer < 2; ++layer) {
      const LayerMeans mean(own.layers[layer]), truth(paths.layers[layer]);
      differences[2 * layer].push_back(mean.illuminance / truth.illuminance - 1);
      differences[2 * layer + 1].push_back(mean.radiance / truth.radiance - 1);
    }
  }
  for (const std::vector<double>& difference : differences) {
    CHECK_VERDICT(test::mean_is(difference, 0.0, delta));
  }
}

/// Illuminance in lux, of 16 seeds, on a square of 0.6 m around the origin.
std::vector<double> lux_on_floor(const Scene& scene) {
  std::vector<double> lux;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    const RenderResult result =
        render(scene, test::above(0, 0, 0.4, 0.6), test::device(), gathering(4, 60'000, seed));
    lux.push_back(LayerMeans(result.layers.layers[0]).illuminance);
  }
  return lux;
}

/// The mean over that square of an illuminance that depends on the place.
template <class Lux>
double mean_on_floor(const Lux& lux) {
  constexpr int cells = 60;
  double sum = 0;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      sum += lux(glm::dvec3((i + 0.5) / cells - 0.5, (j + 0.5) / cells - 0.5, 0) * 0.6);
    }
  return sum / (cells * cells);
}

test::SceneBuilder black_floor() {
  test::SceneBuilder builder;
  builder.grid({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, builder.add(test::diffuse(glm::vec3(0.0f))));
  return builder;
}

PhotonTracerResult traced(const Scene& scene, bool keep_caustics) {
  PhotonTracerParameters parameters;
  parameters.emitted_photons = 20'000;
  parameters.keep_caustics = keep_caustics;
  return trace_photons(RayScene(scene), parameters);
}

}  // namespace

TEST_CASE("final gathering: a furnace reads its closed form, in a corner and with a mirror, too") {
  const auto [place, has_mirror] =
      GENERATE(table<double, bool>({{0.5, false}, {0.1, false}, {0.5, true}}));
  CAPTURE(place, has_mirror);
  constexpr double albedo = 0.5;
  const double emitted = 1 / ((has_mirror ? 5 : 6) * pi);
  const Scene scene = furnace(albedo, has_mirror);
  std::vector<double> lux, radiance;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) {
    RenderParameters parameters = gathering(16, 20'000, seed);
    parameters.film.samples_per_pixel = 16;
    const RenderResult result =
        render(scene, test::above(place, place, 0.3, 0.6 * place), test::device(), parameters);
    lux.push_back(LayerMeans(result.layers.layers[0]).illuminance);
    radiance.push_back(LayerMeans(result.layers.layers[0]).radiance);
  }
  const double truth = emitted / (1 - albedo);
  CHECK_VERDICT(test::mean_is(lux, pi * truth, 0.05 * pi * truth));
  CHECK_VERDICT(test::mean_is(radiance, truth, 0.04 * truth));
}

TEST_CASE("final gathering: layers of a furnished room are those of paths", "[long]") {
  SECTION("a diffuse floor") { check_gathered_room(test::diffuse(glm::vec3(0.7f)), 0.06); }
  SECTION("a glossy floor") {
    check_gathered_room(test::glossy(glm::vec3(0.4f), glm::vec3(0.3f), 0.3f), 0.06);
  }
}

TEST_CASE("final gathering: light by a mirror alone arrives once") {
  // A lamp that shines up, away from the floor, at a mirror 0.2 m above it.
  test::SceneBuilder builder = black_floor();
  const std::uint32_t black = builder.add(test::diffuse(glm::vec3(0.0f)));
  builder.grid({-9, -9, 1.2f}, {0, 18, 0}, {18, 0, 0}, 1, builder.add(test::mirror({1, 1, 1})));
  builder.grid({1.1f, -0.2f, 1}, {0.2f, 0, 0}, {0, 0.4f, 0}, 1, black,
               builder.add(test::area_light("lamp")));
  const double truth = mean_on_floor([](const glm::dvec3& point) {
    return validation::rectangle_factor(point, {0, 0, 1}, {1.1, -0.2, 1.4}, {0.2, 0, 0},
                                        {0, 0.4, 0}) /
           (0.2 * 0.4);
  });
  CHECK_VERDICT(test::mean_is(lux_on_floor(builder.build()), truth, 0.1 * truth));
}

TEST_CASE("final gathering: light through glass that does not bend it arrives once") {
  // Shadow rays end at thick glass, whatever its index: all light is a caustic.
  test::SceneBuilder builder = black_floor();
  builder.box({-3, -3, 0.5f}, {3, 3, 0.8f}, builder.add(test::glass(1.0f)), false);
  builder.add(test::point_light("lamp", {0, 0, 1}));
  const double truth = mean_on_floor([](const glm::dvec3& point) {
    const double squared = glm::dot(point, point) + 1;
    return 1 / (4 * pi * squared * std::sqrt(squared));
  });
  CHECK_VERDICT(test::mean_is(lux_on_floor(builder.build()), truth, 0.1 * truth));
}

TEST_CASE("final gathering: caustics are photons that met mirrors or glass and nothing else") {
  SECTION("a diffuse room has none") {
    CHECK(traced(test::furnished_room(), true).caustics.size() == 0);
  }
  SECTION("light through a pane is direct light") {
    test::SceneBuilder builder = black_floor();
    builder.grid({-2, -2, 0.5f}, {4, 0, 0}, {0, 4, 0}, 1, builder.add(test::glass(1.5f, true)));
    builder.add(test::point_light("lamp", {0, 0, 1}));
    const PhotonTracerResult result = traced(builder.build(), true);
    CHECK(result.photons.size() > 0);
    CHECK(result.caustics.size() == 0);
  }
  SECTION("they are kept only where they are asked for, and change no other photon") {
    Scene scene = test::furnished_room();
    scene.materials[1] = test::mirror(glm::vec3(0.9f));
    const PhotonTracerResult with = traced(scene, true), without = traced(scene, false);
    CHECK(without.caustics.size() == 0);
    REQUIRE(with.caustics.size() > 0);
    CHECK(with.caustics.light.size() == with.caustics.size());
    CHECK(with.caustics.size() < with.photons.size() / 4);
    CHECK(with.photons.position == without.photons.position);
    CHECK(with.photons.flux == without.photons.flux);
  }
}

TEST_CASE("final gathering: many lights, each in its layer, are what their group is") {
  Scene scene = test::furnished_room();
  scene.materials[2] = test::glossy(glm::vec3(0.2f), glm::vec3(0.4f), 0.2f);
  scene.materials[1] = test::mirror(glm::vec3(0.9f));
  add_lamps(scene, 12);
  RenderParameters parameters = gathering(8, 20'000);
  parameters.radius = 0.3;
  const Camera camera = test::room_camera();
  const LightLayers alone = render(scene, camera, test::device(), parameters).layers;
  REQUIRE(alone.sparse());
  double power = 0;
  for (const Light& light : scene.lights) power += light.power;
  Scene grouped = scene;
  for (Light& light : grouped.lights) light.group = "all";
  const LightLayers together = render(grouped, camera, test::device(), parameters).layers;
  REQUIRE(together.layers.size() == 1);
  const LightLayers dense = alone.dense();
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    double lux = 0, radiance = 0;
    for (std::size_t light = 0; light < scene.lights.size(); ++light) {
      lux += scene.lights[light].power / power * dense.layers[light].illuminance[pixel];
      radiance +=
          scene.lights[light].power / power * luminance(dense.layers[light].radiance[pixel]);
    }
    CHECK(together.layers[0].illuminance[pixel] == Approx(lux).epsilon(1e-4));
    CHECK(luminance(together.layers[0].radiance[pixel]) == Approx(radiance).epsilon(1e-4));
  }
}

TEST_CASE("final gathering: layers are the same whatever the powers") {
  Scene scene = test::furnished_room();
  scene.lights.pop_back();  // half of the looks at lamps go by power; at a single lamp all do
  scene.materials[1] = test::mirror(glm::vec3(0.9f));
  RenderParameters parameters = gathering(8, 20'000);
  parameters.photons.quota = PhotonQuota::equal;
  const LightLayers dim = render(scene, test::room_camera(), test::device(), parameters).layers;
  scene.lights[0].power *= 1000;
  CHECK(
      test::same_bits(dim, render(scene, test::room_camera(), test::device(), parameters).layers));
}

TEST_CASE("final gathering: one, two and three threads render the same bits") {
  Scene scene = test::furnished_room(2);
  scene.materials[1] = test::mirror(glm::vec3(0.9f));
  scene.materials[2] = test::glossy(glm::vec3(0.2f), glm::vec3(0.4f), 0.2f);
  RenderParameters parameters = gathering(8, 20'000);
  parameters.passes = 2;
  std::vector<LightLayers> pictures;
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pictures.push_back(render(scene, test::room_camera(), test::device(), parameters).layers);
  }
  CHECK(test::same_bits(pictures[0], pictures[1]));
  CHECK(test::same_bits(pictures[0], pictures[2]));
}

TEST_CASE("final gathering: maps that are kept render the same bits") {
  Scene scene = test::furnished_room();
  scene.materials[1] = test::mirror(glm::vec3(0.9f));
  RenderParameters parameters = gathering(8, 20'000);
  const Camera camera = test::room_camera();
  const LightLayers once = render(scene, camera, test::device(), parameters).layers;
  SceneRenderer renderer(scene, {&test::device(), 1}, parameters);
  CHECK(test::same_bits(once, renderer.render(camera, parameters.film).layers));
}

TEST_CASE("final gathering: reflections are what the lobe reflects") {
  const float albedo = GENERATE(0.0f, 0.5f);
  Scene scene = test::furnished_room();
  scene.materials[0] = test::glossy(glm::vec3(albedo), glm::vec3(0.3f), 0.3f);
  const RenderParameters parameters = gathering(8, 20'000);
  const Camera camera = test::above(2.0, 2.6, 2.0, 0.4);
  SceneRenderer renderer(scene, {&test::device(), 1}, parameters);
  const LightLayers all = renderer.render(camera, parameters.film).layers;
  const LightLayers lobe = renderer.render_reflections(camera, parameters.film).layers;
  CHECK(test::same_bits(all, lobe) == (albedo == 0.0f));
  CHECK(LayerMeans(lobe.layers[0]).radiance <= LayerMeans(all.layers[0]).radiance);
  CHECK(LayerMeans(lobe.layers[0]).radiance > 0);
}

TEST_CASE("final gathering: what it cannot do is refused") {
  const Scene scene = test::closed_box(test::diffuse(glm::vec3(0.5f)));
  const Camera camera = test::above(0.5, 0.5, 0.5, 0.1);
  CHECK_THROWS_AS(render(scene, camera, test::device(), gathering(1'000'000, 1000)), UsageError);
  CHECK_THROWS_AS(render(scene, camera, test::device(), gathering(-1, 1000)), UsageError);
  const Sensor sensor{{0.5, 0.5, 0}, {0, 0, 1}};
  const std::span<Device> devices(&test::device(), 1);
  CHECK_THROWS_AS(measure(scene, {&sensor, 1}, devices, gathering(4, 1000)), UsageError);
  CHECK_THROWS_AS(gather(scene, {&sensor, 1}, {}, devices, gathering(4, 1000)), UsageError);
  PreparedPhotons prepared;
  CHECK_THROWS_AS(SceneRenderer(scene, devices, gathering(4, 1000), &prepared), UsageError);
}

}  // namespace photile::test
