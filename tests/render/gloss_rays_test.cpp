// Reflections by lobes.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include <tbb/global_control.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <numbers>

#include "cache/surface_cache.hpp"
#include "pictures.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

// Light that lobes reflect, by rays: --set gloss=rays.

RenderParameters with_rays(std::uint64_t seed = 1) {
  RenderParameters parameters = small_picture(50'000, 8, 8, 16);
  parameters.gloss = GlossMode::rays;
  parameters.light_maps = LightMapMode::on;
  parameters.seed = seed;
  return parameters;
}

RenderParameters many_rays() {
  RenderParameters parameters = with_rays();
  parameters.photons.emitted_photons = 400'000;
  parameters.light_map_rays = 128;
  parameters.neighbours = 200;
  return parameters;
}

Scene glossy_room(const Material& floor) {
  Scene scene = furnished_room(3);
  scene.materials[0] = floor;
  return scene;
}

/// A box of 96 m2 whose walls reflect that part of the light, and all emit the same.
void add_furnace(float albedo, SceneBuilder& builder) {
  const std::uint32_t wall = builder.add(diffuse(albedo));
  const std::uint32_t walls = builder.add(area_light("walls"));
  builder.box(glm::vec3(-2.0f), glm::vec3(2.0f), wall, true, 1, walls);
}

/// A plate of this material in a box whose black walls all emit the same.
Scene plate_in_furnace(const Material& material) {
  SceneBuilder builder;
  add_furnace(0, builder);
  builder.grid({-1, -1, -1.5f}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(material));
  return builder.build();
}

/// A lamp of 0.5 m, one metre above a plate of this material, and a camera whose middle looks at
/// the lamp's image.
Scene plate_under_lamp(const Material& material) {
  SceneBuilder builder;
  const std::uint32_t black = builder.add(diffuse(0.0f));
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 1, builder.add(material));
  builder.grid({-0.25f, -0.25f, 1}, {0, 0.5f, 0}, {0.5f, 0, 0}, 1, black,
               builder.add(area_light("lamp")));
  return builder.build();
}

Camera at_image() { return Camera::look_at({0, -1.5, 1}, {0, -0.75, 0}, {0, 0, 1}, 0.5); }

/// Whether a plate reflects uniform light from all sides as its BSDF's integral says.
void check_in_furnace(double albedo, double f0, double alpha) {
  CAPTURE(albedo, f0, alpha);
  const Scene scene =
      plate_in_furnace(glossy(glm::vec3(static_cast<float>(albedo)),
                              glm::vec3(static_cast<float>(f0)), static_cast<float>(alpha)));
  // 96 m2 of walls, power 1.
  const double truth = validation::glossy_reflectance(albedo, f0, alpha) / (96 * pi);
  const std::vector<double> radiance = of_seeds([&](std::uint64_t seed) {
    RenderParameters parameters = with_rays(seed);
    if (albedo > 0) {
      parameters.photons.emitted_photons = 220'000;
      parameters.neighbours = 1'100;
    }
    const RenderResult result = render(scene, above(0, 0, 0.5, 0.2), device(), parameters);
    return LayerMeans(result.layers.layers[0]).radiance / truth;
  });
  CHECK_VERDICT(mean_is(radiance, 1.0, 0.06));
}

TEST_CASE("gloss by rays: uniform light from all sides is reflected as the BSDF's integral says") {
  check_in_furnace(0.5, 0.04, 0.4);
  check_in_furnace(0.0, 0.9, 0.25);
}

TEST_CASE("gloss by rays: narrow lobes and others reflect uniform light likewise", "[slow]") {
  check_in_furnace(1.0, 0.04, 0.1);
  check_in_furnace(0.0, 0.9, 0.05);
  check_in_furnace(0.3, 0.2, 0.2);
}

/// Whether a plate in a box of white walls reflects the light that is everywhere in it.
void check_light_of_walls(double albedo, double f0, double alpha) {
  CAPTURE(albedo, f0, alpha);
  // Three quarters of the light in the box were reflected before; a plate of 10 cm takes 0.05% of
  // it.
  constexpr double wall_albedo = 0.75;
  SceneBuilder builder;
  add_furnace(wall_albedo, builder);
  builder.grid({-0.05f, -0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, 1,
               builder.add(glossy(glm::vec3(static_cast<float>(albedo)),
                                  glm::vec3(static_cast<float>(f0)), static_cast<float>(alpha))));
  const Scene scene = builder.build();
  const Camera camera = Camera::look_at({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0}, 0.1);
  const double truth =
      validation::glossy_reflectance(albedo, f0, alpha) / (96 * pi * (1 - wall_albedo));
  const std::vector<double> radiance = of_seeds([&](std::uint64_t seed) {
    RenderParameters parameters = with_rays(seed);
    parameters.light_map_rays = 16;
    parameters.film.samples_per_pixel = 64;
    // Few nodes lie on the plate, or are seen in it, and share the photons that they see.
    parameters.photons.emitted_photons = 800'000;
    if (albedo > 0) parameters.light_map_rays = 64;
    const RenderResult result = render(scene, camera, device(), parameters);
    return LayerMeans(result.layers.layers[0]).radiance / truth;
  });
  CHECK_VERDICT(mean_is(radiance, 1.0, 0.02));
}

TEST_CASE("gloss by rays: lobes read, where nodes gather, what walls reflect of their own light",
          "[slow]") {
  check_light_of_walls(0.0, 0.9, 0.25);
}

TEST_CASE("gloss by rays: lobes of polish and of coats read what walls reflect likewise",
          "[slow]") {
  check_light_of_walls(0.2, 0.2, 0.1);
  check_light_of_walls(0.0, 0.9, 0.04);
}

/// Whether a lamp's image in a plate is the path tracer's.
void check_image_of_lamp(float alpha) {
  CAPTURE(alpha);
  const Scene scene = plate_under_lamp(glossy(0.0f, 0.6f, alpha));
  const std::vector<double> ratio = of_seeds([&](std::uint64_t seed) {
    RenderParameters parameters = with_rays(seed);
    parameters.film.samples_per_pixel = 64;
    const double own =
        LayerMeans(render(scene, at_image(), device(), parameters).layers.layers[0]).radiance;
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 1024;
    film.seed = seed + 100;
    return own / LayerMeans(trace_paths(scene, at_image(), film).layers.layers[0]).radiance;
  });
  CHECK_VERDICT(mean_is(ratio, 1.0, 0.05));
}

TEST_CASE("gloss by rays: a lamp's image in a plate is the path tracer's") {
  check_image_of_lamp(0.1f);
}
TEST_CASE("gloss by rays: a lamp's image is the path tracer's in narrow and wide lobes", "[slow]") {
  check_image_of_lamp(0.03f);
  check_image_of_lamp(0.28f);
}

TEST_CASE("gloss by rays: one sample of rough metal shows what it reflects without confetti") {
  // Its lobe looks half at a white ceiling, half at a black one: one ray would give all or nothing,
  // with a relative variance of 1.
  SceneBuilder builder;
  builder.grid({-3, -3, 0}, {6, 0, 0}, {0, 9, 0}, 1, builder.add(glossy(0.0f, 0.9f, 0.05f)));
  builder.grid({0, -3, 1}, {0, 9, 0}, {3, 0, 0}, 1, builder.add(diffuse(0.8f)));
  builder.grid({-3, -3, 1}, {0, 9, 0}, {3, 0, 0}, 1, builder.add(diffuse(0.0f)));
  Scene scene = builder.build();
  scene.lights = {point_light("lamp", {0.0f, 4.0f, 0.5f})};
  const Camera camera = Camera::look_at({0, -1, 0.8}, {0, 0, 0}, {0, 0, 1}, 0.005);
  RenderParameters parameters = with_rays();
  parameters.film.width = parameters.film.height = 32;
  parameters.film.samples_per_pixel = 1;
  const RenderResult result = render(scene, camera, device(), parameters);
  double sum = 0, squares = 0;
  const std::vector<glm::vec3>& pixels = result.layers.layers[0].radiance;
  for (const glm::vec3& pixel : pixels) {
    sum += luminance(glm::dvec3(pixel));
    squares += std::pow(luminance(glm::dvec3(pixel)), 2);
  }
  const auto count = static_cast<double>(pixels.size());
  const double relative_variance = squares * count / (sum * sum) - 1;
  CAPTURE(relative_variance, sum / count);
  CHECK(sum > 0);
  CHECK(relative_variance < 0.3);
}

TEST_CASE("gloss by rays: a coated wall beside a lamp has no dark pixels") {
  // A pane of light that stands on the edge of a plate. A light sample on it near a point of the
  // plate has a weight of inverse squared distance, and a coat lets less through at grazing angles.
  const float alpha = GENERATE(0.05f, 0.2f);
  CAPTURE(alpha);
  SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(glossy(0.75f, 0.04f, alpha)));
  builder.grid({-1, 1, 0}, {2, 0, 0}, {0, 0, 1}, 1, builder.add(diffuse(0.0f)),
               builder.add(area_light("pane")));
  const Scene scene = builder.build();
  RenderParameters parameters = with_rays();
  parameters.light_map_rays = 64;
  parameters.film.width = parameters.film.height = 64;
  const Camera camera = Camera::look_at({0, 0.9, 1}, {0, 0.9, 0}, {0, 1, 0}, 0.2);
  const LightLayers layers = render(scene, camera, device(), parameters).layers;
  const auto width = static_cast<std::size_t>(layers.width);
  const std::vector<glm::vec3>& radiance = layers.layers[0].radiance;
  for (std::size_t y = 1; y + 1 < width; ++y) {
    double row = 0;
    for (std::size_t x = 0; x < width; ++x) row += radiance[y * width + x].g;
    row /= static_cast<double>(width);
    if (!(row > 0)) continue;
    for (std::size_t x = 0; x < width; ++x) {
      CAPTURE(x, y);
      CHECK(radiance[y * width + x].g > 0.7 * row);
    }
  }
}

TEST_CASE("gloss by rays: the narrowest lobe reflects a room as a mirror does", "[slow]") {
  const auto radiance_of = [](const Material& material, std::uint64_t seed) {
    RenderParameters parameters = with_rays(seed);
    parameters.film.samples_per_pixel = 256;
    const Scene scene = plate_under_lamp(material);
    return LayerMeans(render(scene, at_image(), device(), parameters).layers.layers[0]).radiance;
  };
  const std::vector<double> ratio = of_seeds([&](std::uint64_t seed) {
    return radiance_of(glossy(0.0f, 1.0f, 0.02f), seed) / radiance_of(mirror(1.0f), seed);
  });
  CHECK_VERDICT(mean_is(ratio, 1.0, 0.03));
}

TEST_CASE("gloss by rays: lobes and light maps together see what paths see", "[long][slow]") {
  const RenderParameters parameters = many_rays();
  check_room(furnished_room(3), glossy(0.4f, 0.3f, 0.1f), parameters, 0.06);
  check_room(furnished_room(3), glossy(0.6f, 0.04f, 0.5f), parameters, 0.06);
}

TEST_CASE("gloss by rays: with light samples at each hit they see what paths see, too",
          "[long][slow]") {
  RenderParameters parameters = many_rays();
  parameters.light_maps = LightMapMode::off;
  parameters.direct_rays = 2;
  check_room(furnished_room(3), glossy(0.4f, 0.3f, 0.1f), parameters, 0.06);
}

TEST_CASE("gloss by rays: illuminance is that of the surface seen, as without lobes") {
  const Material base = diffuse(0.4f);
  RenderParameters parameters = with_rays();
  const Camera camera = above(2.6, 2.2, 2.0, 0.4);
  // Photons bounce alike where the lobe reflects next to nothing.
  const Scene faint = glossy_room(glossy(base.diffuse, glm::vec3(0.0f), 0.5f));
  const LightLayers with = render(faint, camera, device(), parameters).layers;
  const LightLayers without = render(glossy_room(base), camera, device(), parameters).layers;
  CHECK(LayerMeans(with.layers[0]).illuminance ==
        Approx(LayerMeans(without.layers[0]).illuminance).epsilon(0.1));
}

TEST_CASE("gloss by rays: the same bits on any number of threads and in any rows") {
  const Scene scene = glossy_room(glossy(0.4f, 0.3f, 0.1f));
  RenderParameters parameters = with_rays();
  parameters.light_map_rays = GENERATE(0, 8);
  parameters.film.width = 48;
  parameters.film.height = 36;
  parameters.film.samples_per_pixel = 2;
  const Camera camera = room_camera();
  std::vector<LightLayers> pictures;
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pictures.push_back(render(scene, camera, device(), parameters).layers);
  }
  CHECK(same_bits(pictures[0], pictures[1]));
  CHECK(same_bits(pictures[0], pictures[2]));
  CHECK(same_bits(pictures[0], picture_in_parts(scene, camera, parameters)));
}

TEST_CASE("gloss by rays: layers are the same whatever the powers") {
  Scene scene = glossy_room(glossy(0.4f, 0.3f, 0.1f));
  scene.lights.pop_back();  // with one lamp the choice does not depend on it
  const LightLayers dim = render(scene, room_camera(), device(), with_rays()).layers;
  scene.lights[0].power *= 1024;
  const LightLayers bright = render(scene, room_camera(), device(), with_rays()).layers;
  CHECK(same_bits(dim, bright));
}

TEST_CASE("gloss by rays: where nothing is glossy, not a bit changes") {
  const Scene scene = furnished_room(3);
  RenderParameters parameters = with_rays();
  const LightLayers by_rays = render(scene, room_camera(), device(), parameters).layers;
  parameters.gloss = GlossMode::photons;
  CHECK(same_bits(by_rays, render(scene, room_camera(), device(), parameters).layers));
}

TEST_CASE("gloss by rays: rays are for light maps unless asked for") {
  const Scene scene = glossy_room(glossy(0.4f, 0.3f, 0.1f));
  RenderParameters parameters = with_rays();
  parameters.gloss = GlossMode::automatic;
  const auto used = [&] { return render(scene, room_camera(), device(), parameters).used.gloss; };
  CHECK(used() == GlossMode::filtered);
  parameters.light_maps = LightMapMode::off;
  CHECK(used() == GlossMode::photons);
  parameters.gloss = GlossMode::rays;
  CHECK(used() == GlossMode::rays);
}

// Where the noise of photon estimates is not seen in what lobes reflect.

/// Hits of pixel 5 that weigh so much together, each so far from the one before, metres.
PrimaryHits hits_in_a_row(std::size_t count, double apart, double weight) {
  PrimaryHits hits;
  for (std::size_t i = 0; i < count; ++i) {
    hits.position.emplace_back(static_cast<double>(i) * apart, 0.0, 0.0);
    hits.oriented_face.push_back(0);
    hits.pixel.push_back(5);
    hits.throughput.emplace_back(weight / static_cast<double>(count));
    hits.diffuse_albedo.emplace_back(1.0f);
  }
  return hits;
}

bool all_suit(const PrimaryHits& seen, const PrimaryHits& reflected, double noise) {
  const std::vector<std::uint8_t> suits =
      cache::suits_photons(seen, reflected, 1, {.width = 0.1, .noise = noise});
  REQUIRE(suits.size() == reflected.size());
  CHECK(std::all_of(suits.begin(), suits.end(), [&](auto one) { return one == suits.front(); }));
  return suits.front() != 0;
}

TEST_CASE("photons suit reflections that count little beside the surface that shows them") {
  // A share of 1 / (1 + 9) of the pixel's light: noise of 89% is 8.9% there, of 91% is 9.1%.
  const PrimaryHits base = hits_in_a_row(16, 0.0, 0.45), faint = hits_in_a_row(16, 0.0, 0.05);
  CHECK(all_suit(base, faint, 0.89));
  CHECK_FALSE(all_suit(base, faint, 0.91));
  // On black it is all that the pixel shows.
  CHECK_FALSE(all_suit(hits_in_a_row(16, 0.0, 0.0), faint, 0.091));
  CHECK_FALSE(all_suit({}, faint, 0.091));
  CHECK(all_suit({}, faint, 0.089));
}

TEST_CASE("photons suit reflections of many independent estimates, whose noise averages out") {
  // 16 of them have a quarter of the noise of one.
  CHECK(all_suit({}, hits_in_a_row(16, 0.1, 0.7), 4 * 0.089));
  CHECK_FALSE(all_suit({}, hits_in_a_row(16, 0.1, 0.7), 4 * 0.091));
  // Hits that err alike are of no use.
  CHECK_FALSE(all_suit({}, hits_in_a_row(16, 0.0001, 0.7), 0.091));
  // Four pairs, far from each other: as four.
  PrimaryHits pairs = hits_in_a_row(8, 0.0, 0.7);
  for (std::size_t i = 0; i < 8; ++i) pairs.position[i].x = static_cast<float>(i / 2);
  CHECK(all_suit({}, pairs, 2 * 0.089));
  CHECK_FALSE(all_suit({}, pairs, 2 * 0.091));
}

TEST_CASE("photons do not suit strong reflections of what is near") {
  // Two hits of a lobe, 0.19 m and 0.21 m beyond the surface that shows them: two widths are 0.2 m.
  PrimaryHits reflected = hits_in_a_row(2, 0.02, 0.5);
  const auto suits_on = [&](double base) {
    PrimaryHits seen = hits_in_a_row(1, 0.0, base);
    seen.position[0].x = -0.19f;
    return cache::suits_photons(seen, reflected, 1, {.width = 0.1, .noise = 0.05});
  };
  CHECK(suits_on(0.1) == std::vector<std::uint8_t>{0, 1});
  // On a bright base it shows little.
  CHECK(suits_on(0.9) == std::vector<std::uint8_t>{1, 1});
}

TEST_CASE("photons suit reflections pixel by pixel") {
  PrimaryHits reflected = hits_in_a_row(2, 0.0, 1.0);
  PrimaryHits seen = hits_in_a_row(1, 0.0, 99.0);
  reflected.pixel[0] = 4;  // where nothing else is seen
  const std::vector<std::uint8_t> suits =
      cache::suits_photons(seen, reflected, 1, {.width = 0.1, .noise = 0.1});
  CHECK(suits == std::vector<std::uint8_t>{0, 1});
  CHECK(cache::suits_photons(seen, {}, 1, {.width = 0.1, .noise = 0.1}).empty());
}

}  // namespace
}  // namespace photile::test
