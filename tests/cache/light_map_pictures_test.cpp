// Pictures that read light maps, beside the estimate at each hit, closed forms and each other.
#include <catch2/catch.hpp>
#include <cmath>
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include <tbb/global_control.h>

#include <glm/gtc/constants.hpp>
#include <limits>
#include <memory>

#include "cache/surface_cache.hpp"
#include "light/light_at_points.hpp"
#include "photile/light_layers.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"
#include "render/picture_in_parts.hpp"
#include "render/pictures.hpp"
#include "render/quality.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {

using test::room_camera;
using test::same_bits;

namespace {

RenderParameters with_light_maps() {
  RenderParameters parameters = small_picture(30'000, 64, 48);
  parameters.light_maps = LightMapMode::on;
  return parameters;
}

/// Rows of many lights, a lamp and its copies side by side.
Scene many_lamps() {
  Scene scene = test::furnished_room(2);
  add_lamps(scene, 20);
  return scene;
}

/// Mean over pixels of (value - expected)^2 / expected^2 of the first light, on a plate of albedo 1
/// under a lamp of 1 W straight above its middle, seen from above.
double error_of_lamp(const LightLayers& layers, double height, double side) {
  double sum = 0;
  for (int y = 0; y < layers.height; ++y) {
    for (int x = 0; x < layers.width; ++x) {
      const double px = ((x + 0.5) / layers.width - 0.5) * side;
      const double py = ((y + 0.5) / layers.height - 0.5) * side;
      const double squared = px * px + py * py + height * height;
      const double irradiance = height / (4 * glm::pi<double>() * std::pow(squared, 1.5));
      const double value =
          layers.layers[0].illuminance[static_cast<std::size_t>(y * layers.width + x)];
      sum += std::pow(value / irradiance - 1, 2);
    }
  }
  return sum / (layers.width * layers.height);
}

}  // namespace

TEST_CASE("Light maps are no farther from a lamp's closed form than estimates at hits") {
  Scene scene = test::plate(test::diffuse(glm::vec3(1.0f)), 4, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}));
  RenderParameters parameters = with_light_maps();
  parameters.photons.emitted_photons = 400'000;
  parameters.neighbours = 200;
  parameters.film.width = parameters.film.height = 48;
  const Camera camera = test::above(0, 0, 30, 2.4);
  const double by_maps =
      error_of_lamp(render(scene, camera, test::device(), parameters).layers, 1, 2.4);
  parameters.light_maps = LightMapMode::off;
  const double at_hits =
      error_of_lamp(render(scene, camera, test::device(), parameters).layers, 1, 2.4);
  CAPTURE(by_maps, at_hits);
  CHECK(at_hits < 2.0 / 200);  // noise of k photons, and some bias
  CHECK(by_maps <= 1.02 * at_hits);
}

TEST_CASE("Nodes are as far apart as the radius asks, and no closer than half the photons are") {
  const Scene scene = test::furnished_room(2);
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 2'000}).photons;
  const std::vector<double> powers = light::layer_powers(scene);
  const auto spacing = [&](double radius) {
    return cache::light_map_parameters(scene, photons, 100, radius, 60, 0, 0, powers).spacing;
  };
  CHECK(spacing(0.4) == 2 * spacing(0.2));
  CHECK(spacing(0.4) < 0.4);
  // Half the median distance to the nearest photon, in steps of two.
  const double nearest = automatic_radius(photons, 1) / 2;
  for (const double radius : {1e-4, 1e-8, 1e-12}) {
    CAPTURE(radius);
    CHECK(spacing(radius) >= nearest / 2);
    CHECK(spacing(radius) < nearest);
  }
  CHECK(spacing(2 * nearest) < 1.5 * nearest);  // which is not held back
}

TEST_CASE("Pictures that read light maps are the same bits on one, two and three threads") {
  for (const Scene& scene : {test::furnished_room(3), many_lamps()}) {
    std::vector<LightLayers> pictures;
    for (const std::size_t threads : {1u, 2u, 3u}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      pictures.push_back(render(scene, room_camera(), test::device(), with_light_maps()).layers);
    }
    CHECK(same_bits(pictures[0], pictures[1]));
    CHECK(same_bits(pictures[0], pictures[2]));
  }
}

TEST_CASE("What was looked at before changes no bit of a picture") {
  const Scene scene = test::furnished_room(2);
  const RenderParameters parameters = with_light_maps();
  SceneRenderer renderer(scene, std::span(&test::device(), 1), parameters);
  Film coarse = parameters.film;
  coarse.width = 16, coarse.height = 12, coarse.samples_per_pixel = 1;
  renderer.render(Camera::look_at({0.5, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0), coarse);
  renderer.render(room_camera(), coarse);
  const RenderResult kept = renderer.render(room_camera(), parameters.film);
  const RenderResult again = renderer.render(room_camera(), parameters.film);
  const RenderResult fresh = render(scene, room_camera(), test::device(), parameters);
  CHECK(same_bits(kept.layers, fresh.layers));
  CHECK(same_bits(again.layers, fresh.layers));
}

TEST_CASE("Rows traced in several batches change no bit of a picture") {
  const Scene scene = test::furnished_room(2);
  const RenderParameters parameters = with_light_maps();
  const RenderResult whole = render(scene, room_camera(), test::device(), parameters);
  CHECK(same_bits(whole.layers, test::picture_in_parts(scene, room_camera(), parameters)));
}

TEST_CASE("A first picture shows a lamp's closed form, whatever brings that light later") {
  Scene scene = test::plate(test::diffuse(glm::vec3(1.0f)), 2, 1);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}));
  constexpr double side = 0.8;
  const Camera camera = test::above(0, 0, 10, side);
  RenderParameters parameters = with_light_maps();
  parameters.maps = GENERATE(MapMode::automatic, MapMode::naive);
  parameters.light_maps = LightMapMode::automatic;
  parameters.direct_rays = GENERATE(0, 1);
  parameters.light_map_rays = GENERATE(0, 64);
  constexpr double power = 3;
  const int width = parameters.film.width, height = parameters.film.height;
  std::vector<glm::vec3> picture(static_cast<std::size_t>(width * height));
  SceneRenderer renderer(scene, std::span(&test::device(), 1),
                         first_picture_parameters(parameters));
  renderer.draw(camera, {width, height, 1}, std::vector{glm::vec3(power)},
                std::numeric_limits<double>::infinity(), picture);
  double mean = 0, expected = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double px = ((x + 0.5) / width - 0.5) * side * width / height;
      const double py = ((y + 0.5) / height - 0.5) * side;
      const double irradiance =
          power / (4 * glm::pi<double>() * std::pow(px * px + py * py + 1, 1.5));
      expected += irradiance / glm::pi<double>();
      mean += picture[static_cast<std::size_t>(y * width + x)].y;
    }
  }
  CHECK(mean / expected == Approx(1).margin(0.1));
}

TEST_CASE("A hit on a wall reads the same light from wherever it is seen") {
  // Cameras that look straight at the same points of a plate, from nearer and farther.
  Scene scene = test::plate(test::diffuse(glm::vec3(0.5f)), 2, 1);
  scene.lights.push_back(test::point_light("lamp", {0.3f, 0.2f, 1}));
  RenderParameters parameters = with_light_maps();
  SceneRenderer renderer(scene, std::span(&test::device(), 1), parameters);
  const RenderResult first = renderer.render(test::above(0, 0, 10, 1.6), parameters.film);
  renderer.render(test::above(0.2, 0.1, 3, 1.0), parameters.film);
  const RenderResult later = renderer.render(test::above(0, 0, 10, 1.6), parameters.film);
  CHECK(same_bits(first.layers, later.layers));
}

TEST_CASE("Automatic light maps are read by pictures, but not by several passes or naive maps") {
  const Scene scene = test::furnished_room(2);
  RenderParameters parameters = with_light_maps();
  parameters.light_maps = LightMapMode::automatic;
  const auto used = [&] {
    return render(scene, room_camera(), test::device(), parameters).used.light_maps;
  };
  CHECK(used() == LightMapMode::on);
  parameters.passes = 2;
  CHECK(used() == LightMapMode::off);
  parameters.passes = 1;
  parameters.maps = MapMode::naive;
  CHECK(used() == LightMapMode::off);
}

TEST_CASE("Bounded light maps whose nodes gather draw the same bits") {
  const Scene scene = test::furnished_room(2);
  RenderParameters parameters = with_light_maps();
  parameters.light_map_rays = 8;
  const auto renderer = [&] {
    return std::make_unique<SceneRenderer>(scene, std::span(&test::device(), 1), parameters);
  };
  const auto free = renderer(), bounded = renderer();
  const Film film{24, 16, 1};
  const std::vector<glm::vec3> powers(light_groups_of(scene).groups.size(), glm::vec3(1.0f));
  const auto draw = [&](SceneRenderer& from, double x) {
    std::vector<glm::vec3> picture(24 * 16);
    from.draw(Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0), film, powers,
              std::numeric_limits<double>::infinity(), picture);
    return picture;
  };
  bounded->bound_light_maps(1);
  for (const double x : {0.5, 1.5, 0.5, 2.5}) CHECK(draw(*bounded, x) == draw(*free, x));
}

TEST_CASE("Glossy surfaces keep the estimate at the hit where photons bring gloss") {
  // Only the table is glossy: pixels that see nothing else are those of an estimate at each hit.
  test::SceneBuilder builder;
  builder.grid({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, builder.add(test::diffuse(glm::vec3(0.5f))));
  builder.grid({-0.5f, -0.5f, 0.3f}, {1, 0, 0}, {0, 1, 0}, 1,
               builder.add(test::glossy(glm::vec3(0.4f), glm::vec3(0.05f), 0.3f)));
  builder.add(test::point_light("lamp", {0.3f, 0.2f, 1}, 1.0));
  const Scene scene = builder.build();
  RenderParameters parameters = with_light_maps();
  parameters.gloss = GlossMode::photons;
  const Camera camera = test::above(0, 0, 10, 0.6);
  const RenderResult maps = render(scene, camera, test::device(), parameters);
  parameters.light_maps = LightMapMode::off;
  const RenderResult hits = render(scene, camera, test::device(), parameters);
  const auto& a = maps.layers.layers[0].radiance;
  const auto& b = hits.layers.layers[0].radiance;
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].x == Approx(b[i].x).epsilon(1e-5));  // sums of photons in another order
  }
}

}  // namespace photile::test
