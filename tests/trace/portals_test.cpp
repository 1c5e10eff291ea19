// Photons and looks through windows: what they find is what there is without them, sooner.
#include "trace/portals.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "photile/errors.hpp"
#include "photile/photons.hpp"
#include "photile/sensors.hpp"
#include "room_with_window.hpp"
#include "statistical_tests.hpp"
#include "suns.hpp"
#include "trace/light_emitter.hpp"
#include "trace/light_sampler.hpp"
#include "trace/portal_search.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {

using namespace trace;

namespace {

using std::numbers::pi;
using Room = RoomWithWindow;

Scene room_under_even_sky(const Material& walls) {
  Scene scene = Room::builder(walls).build();
  add_environment(scene, even_surroundings());
  return scene;
}

/// Photons that the walls of the room hold on their inside.
struct Inside {
  double flux = 0;
  std::size_t count = 0;
};
Inside inside(const Scene& scene, std::uint64_t seed, std::uint64_t paths) {
  const Photons photons =
      trace_photons(RayScene(scene), {.emitted_photons = paths, .seed = seed}).photons;
  Inside found;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    if (!Room::inside(scene, photons.oriented_face[i])) continue;
    found.flux += luminance(photons.flux[i]);
    ++found.count;
  }
  return found;
}

std::vector<double> fluxes_inside(const Scene& scene, std::uint64_t paths) {
  return of_seeds([&](std::uint64_t seed) { return inside(scene, seed, paths).flux; });
}

std::vector<double> irradiances(const Scene& scene, const Sensor& sensor, int rays) {
  return of_seeds([&](std::uint64_t seed) {
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = rays}, seed).layers.dense();
    return double{layers.layers.at(0).illuminance.at(0)} * scene.lights[0].power;
  });
}

}  // namespace

TEST_CASE("what enters a window under an even sky is pi L A, whatever part of it is a portal") {
  Scene scene = room_under_even_sky(diffuse(0.0f));
  // The fraction of the light's 1 lm: pi L A over 4 pi L times the disc.
  const double disc = pi * std::pow(bounding_sphere(scene).radius, 2);
  const double truth = Room::window_area / (4 * disc);
  SECTION("none") { CHECK_VERDICT(mean_is(fluxes_inside(scene, 100'000), truth, 0.2 * truth)); }
  SECTION("the window") {
    scene.portals = {Room::window()};
    CHECK_VERDICT(mean_is(fluxes_inside(scene, 20'000), truth, 0.05 * truth));
  }
  SECTION("half of it, twice") {
    scene.portals = {Room::window(0.5f), Room::window(0.5f)};
    CHECK_VERDICT(mean_is(fluxes_inside(scene, 100'000), truth, 0.25 * truth));
  }
  SECTION("a rectangle that is no window") {
    scene.portals = {{{0.5f, 0.2f, 3.0f}, {1, 0, 0}, {0, 2, 0}}};
    CHECK_VERDICT(mean_is(fluxes_inside(scene, 100'000), truth, 0.35 * truth));
  }
}

TEST_CASE("a sun through a window brings its lux times what the window shows") {
  Scene scene = Room::builder(diffuse(0.0f)).build();
  const Light sun =
      sun_along(glm::normalize(glm::vec3(0.1f, -0.4f, 1.0f)), GENERATE(0.0f, 0.0093f));
  scene.lights.push_back(sun);
  scene.portals = {Room::window()};
  const double disc = pi * std::pow(bounding_sphere(scene).radius, 2);
  const double truth = Room::window_area * static_cast<double>(sun.direction.z) / disc;
  CHECK_VERDICT(mean_is(fluxes_inside(scene, 20'000), truth, 0.03 * truth));
}

TEST_CASE("reflected light is the same with portals and without") {
  Scene scene = room_under_even_sky(diffuse(0.5f));
  const auto without = fluxes_inside(scene, 100'000);
  scene.portals = {Room::window()};
  const auto with = fluxes_inside(scene, 20'000);
  const double mean = std::accumulate(with.begin(), with.end(), 0.0) / 16;
  CHECK_VERDICT(mean_is(without, mean, 0.15 * mean));
}

TEST_CASE("portals bring at least ten times the photons") {
  Scene scene = room_under_even_sky(diffuse(0.5f));
  const std::size_t without = inside(scene, 1, 100'000).count;
  scene.portals = {Room::window()};
  CHECK(inside(scene, 1, 100'000).count > 10 * without);
}

TEST_CASE("light samples through a portal find pi L times the window's form factor") {
  Scene scene = room_under_even_sky(diffuse(0.0f));
  const glm::dvec3 corner(Room::left, Room::sill, 0), u(1.2, 0, 0), v(0, 1, 0);
  for (const glm::dvec3& normal : {glm::dvec3(0, 0, -1), glm::normalize(glm::dvec3(0.2, 1, -1))}) {
    const Sensor sensor{{1.5, 0.8, 3.5}, normal};
    const double truth = pi * validation::rectangle_factor(sensor.position, normal, corner, u, v);
    scene.portals = {Room::window()};
    CHECK_VERDICT(mean_is(irradiances(scene, sensor, 1024), truth, 0.02 * truth));
    scene.portals = {Room::window(0.3f)};
    CHECK_VERDICT(mean_is(irradiances(scene, sensor, 2048), truth, 0.12 * truth));
  }
}

TEST_CASE("a ray from the wall around a portal has the density that light samples there have") {
  // It starts a rounding above the wall, before the portal's plane, where the portal looks
  // large; from the wall itself it cannot be seen, and no light sample goes through it.
  Scene scene = room_under_even_sky(diffuse(0.5f));
  scene.portals = {Room::window()};
  const LightSampler lights(scene);
  const glm::vec3 on_wall(0.5f, 1.4f, 0), start = on_wall + glm::vec3(0, 0, 1e-5f);
  const glm::vec3 towards = glm::normalize(glm::vec3(1.8f, 1.4f, 0) - start);
  SelectionProbabilities probabilities;
  lights.weigh(on_wall, {0, 0, 1}, probabilities);
  const DistantLight& sky = lights.distant()[0];
  CHECK(lights.density(sky, start, towards, probabilities) ==
        lights.density(sky, on_wall, towards, probabilities));
}

TEST_CASE("a lamp is as bright beside portals") {
  SceneBuilder builder = Room::builder(diffuse(0.0f));
  builder.add(point_light("lamp", {2, 2, 2}));
  Scene scene = builder.build();
  add_environment(scene, even_surroundings());
  scene.portals = {Room::window()};
  const Sensor sensor{{2, 0.5, 2}, {0, 1, 0}};
  const std::vector<double> values = of_seeds([&](std::uint64_t seed) {
    const auto layers =
        gather_by_paths(scene, std::span(&sensor, 1), {.rays = 512}, seed).layers.dense();
    return double{layers.layers.at(0).illuminance.at(0)};
  });
  const double truth = 1 / (4 * pi * 1.5 * 1.5);
  CHECK_VERDICT(mean_is(values, truth, 0.03 * truth));
}

TEST_CASE("an opening is found from the camera's room, and faces inwards") {
  const Scene scene = Room::builder(diffuse(0.5f)).build();
  const auto portals = find_portals(scene);
  REQUIRE(portals.size() == 1);
  const glm::vec3 across = glm::cross(portals[0].u, portals[0].v);
  CHECK(glm::length(across) > 0.95 * Room::window_area);
  CHECK(glm::length(across) < 1.5 * Room::window_area);
  CHECK(across.z > 0.99f * glm::length(across));
  const glm::vec3 middle = portals[0].corner + 0.5f * (portals[0].u + portals[0].v);
  CHECK(glm::distance(middle, glm::vec3(1.8f, 1.4f, 0.0f)) < 0.2f);
}

TEST_CASE("each of two windows is found once") {
  auto portals = find_portals(Room::builder(diffuse(0.5f), true).build());
  REQUIRE(portals.size() == 2);
  if (portals[0].corner.z > portals[1].corner.z) std::swap(portals[0], portals[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::vec3 middle = portals[i].corner + 0.5f * (portals[i].u + portals[i].v);
    CHECK(glm::distance(middle, glm::vec3(1.8f, 1.4f, i == 0 ? 0.0f : Room::depth)) < 0.2f);
  }
}

TEST_CASE("light on the outer side of a frame comes by the portal that is found") {
  // In a reveal of 30 cm, a pane at its outer end, and bars of a frame 5 cm behind it.
  SceneBuilder builder = Room::builder(diffuse(0.5f));
  const std::uint32_t white = builder.add(diffuse(0.8f));
  const std::uint32_t pane = builder.add(glass(1.5f, true));
  constexpr float left = Room::left, right = Room::right, sill = Room::sill, head = Room::head;
  constexpr float out = -0.3f, at = -0.25f, bar = 0.06f;
  builder.quad({left, sill, out}, {right, sill, out}, {right, head, out}, {left, head, out}, pane);
  builder.quad({left, sill, out}, {left, sill, 0}, {right, sill, 0}, {right, sill, out}, white);
  builder.quad({left, head, out}, {right, head, out}, {right, head, 0}, {left, head, 0}, white);
  builder.quad({left, sill, out}, {left, head, out}, {left, head, 0}, {left, sill, 0}, white);
  builder.quad({right, sill, out}, {right, sill, 0}, {right, head, 0}, {right, head, out}, white);
  const auto beam = [&](float x0, float x1, float y0, float y1) {
    builder.quad({x0, y0, at}, {x1, y0, at}, {x1, y1, at}, {x0, y1, at}, white);
  };
  beam(left, left + bar, sill, head);
  beam(right - bar, right, sill, head);
  beam(left, right, sill, sill + bar);
  beam(left, right, head - bar, head);
  Scene scene = builder.build();
  add_environment(scene, even_surroundings());
  scene.portals = find_portals(scene);
  REQUIRE(scene.portals.size() == 1);
  const Photons photons = trace_photons(RayScene(scene), {.emitted_photons = 200'000}).photons;
  std::vector<float> fluxes;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    if (Room::inside(scene, photons.oriented_face[i])) fluxes.push_back(luminance(photons.flux[i]));
  }
  REQUIRE(fluxes.size() > 10'000);
  std::sort(fluxes.begin(), fluxes.end());
  CHECK(fluxes.back() < 10 * fluxes[fluxes.size() / 2]);
}

TEST_CASE("photons through portals start before all of the scene, wherever it lies") {
  Scene scene = room_under_even_sky(diffuse(0.5f));
  const glm::vec3 moved = GENERATE(glm::vec3(0.0f), glm::vec3(30.0f, -40.0f, 120.0f));
  for (glm::vec3& vertex : scene.vertices) vertex += moved;
  scene.portals = {Room::window()};
  scene.portals[0].corner += moved;
  const LightEmitter emitter(scene, 0, bounding_sphere(scene));
  for (std::uint64_t path = 0; path < 200; ++path) {
    const EmittedRay ray = emitter.emit(RandomStream(3, path, 0));
    for (const glm::vec3& vertex : scene.vertices) {
      REQUIRE(glm::dot(vertex - ray.origin, ray.direction) > -1e-3f);
    }
  }
}

TEST_CASE("panes of a named material are portals that face inwards") {
  SceneBuilder builder = Room::builder(diffuse(0.5f));
  Material pane = glass(1.5f, true);
  pane.name = "window pane";
  const std::uint32_t material = builder.add(pane);
  builder.quad({Room::left, Room::sill, 0}, {Room::right, Room::sill, 0},
               {Room::right, Room::head, 0}, {Room::left, Room::head, 0}, material);
  const Scene scene = builder.build();
  const std::vector<std::string> globs{"window*"};
  const auto portals = portals_of_materials(scene, globs);
  REQUIRE(portals.size() == 1);
  const glm::vec3 across = glm::cross(portals[0].u, portals[0].v);
  CHECK(across.z == Approx(Room::window_area).epsilon(0.01));
  const std::vector<std::string> unknown{"door"};
  CHECK_THROWS_AS(portals_of_materials(scene, unknown), UsageError);
  const std::vector<std::string> both{"auto", "window*"};
  CHECK_THROWS_AS(portals_asked_for(scene, both), UsageError);
}

TEST_CASE("outside there are no portals, nor in a closed room") {
  CHECK(find_portals(closed_box(diffuse(0.5f))).empty());
  CHECK(find_portals(plate(diffuse(0.5f), 2)).empty());
}

}  // namespace photile::test
