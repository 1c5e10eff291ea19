// Lights of scenes: the hash that tells them apart, their names and their flux.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <span>

#include "common/content_hash.hpp"
#include "scene/light_emission.hpp"
#include "scene/light_names.hpp"
#include "scene/scene_queries.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

std::string hash_of(const Scene& scene) {
  ContentHash hash;
  scene::add_scene(scene, hash);
  return hex(hash.digest());
}

/// A scene of one light of every kind that needs data of its own.
Scene scene_with(float texel, double rotation, float candela) {
  Scene scene;
  scene.environments.emplace_back(
      "sky", 2, 1, std::vector<glm::vec3>{glm::vec3(1.0f), glm::vec3(texel)}, rotation);
  scene.distributions.emplace_back("lamp", PhotometricAxes{}, std::vector<double>{0, 90},
                                   std::vector<double>{0, 360},
                                   std::vector<float>{1, candela, 1, candela});
  scene.lights.resize(2);
  return scene;
}

/// The spot falloff of KHR_lights_punctual, integrated over the sphere by the midpoint rule.
double integrated_spot_flux(double intensity, double inner, double outer) {
  constexpr int steps = 200'000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double angle = outer * (i + 0.5) / steps;
    const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    const double attenuation = std::clamp(ramp, 0.0, 1.0);
    sum += 2.0 * pi * std::sin(angle) * attenuation * attenuation * intensity * outer / steps;
  }
  return sum;
}

}  // namespace

TEST_CASE("scenes whose lights differ in anything have different hashes") {
  std::set<std::string> hashes{hash_of(scene_with(2, 0, 3)), hash_of(scene_with(2.001f, 0, 3)),
                               hash_of(scene_with(2, 1, 3)), hash_of(scene_with(2, 0, 3.001f))};
  const std::vector<std::function<void(Light&)>> changes{
      [](Light& light) { light.distribution = 0; },
      [](Light& light) { light.environment = 0; },
      [](Light& light) { light.angular_diameter = 0.01f; },
      [](Light& light) {
        light.x_axis = {0, 1, 0};
      },
      [](Light& light) { light.emission_texture = 0; },
      [](Light& light) { light.texel_radiance.g = 1; },
  };
  for (const auto& change : changes) {
    Scene scene = scene_with(2, 0, 3);
    change(scene.lights[1]);
    hashes.insert(hash_of(scene));
  }
  CHECK(hashes.size() == 4 + changes.size());
}

TEST_CASE("light names lose the bytes that separate EXR channels and command-line parts") {
  CHECK(scene::clean_light_name("Area.001", 50) == "Area_001");
  CHECK(scene::clean_light_name("key lamp=3,a/b\n", 50) == "key_lamp_3_a_b_");
  CHECK(scene::clean_light_name("", 50) == "light");
}

TEST_CASE("light names keep valid UTF-8 and are cut between characters") {
  CHECK(scene::clean_light_name("Küche", 50) == "Küche");
  CHECK(scene::clean_light_name("Küche", 2) == "K");    // ü has two bytes
  CHECK(scene::clean_light_name("K\xC3", 50) == "K_");  // half a character
}

TEST_CASE("equal light names are numbered and stay within the limit") {
  std::vector<Light> lights(3);
  for (Light& light : lights) light.name = std::string(80, 'x');
  scene::make_light_names_unique(lights);
  CHECK(lights[0].name == std::string(50, 'x'));
  CHECK(lights[1].name == std::string(48, 'x') + "_2");
  CHECK(lights[2].name == std::string(48, 'x') + "_3");
}

TEST_CASE("a numbered light name does not collide with a name of the file") {
  std::vector<Light> lights(3);
  lights[0].name = lights[2].name = "lamp";
  lights[1].name = "lamp_2";
  scene::make_light_names_unique(lights);
  CHECK(lights[0].name == "lamp");
  CHECK(lights[1].name == "lamp_2");
  CHECK(lights[2].name == "lamp_3");
}

TEST_CASE("groups whose names are the same when they are cleaned stay two groups") {
  std::vector<Light> lights(3);
  lights[0].group = "desk left";
  lights[1].group = "desk_left";
  lights[2].group = "desk left";
  scene::make_light_names_unique(lights);
  CHECK(lights[0].group == "desk_left");
  CHECK(lights[1].group == "desk_left_2");
  CHECK(lights[2].group == "desk_left");
}

TEST_CASE("names are listed by the letters that differ, and twenty of them") {
  CHECK(scene::names_like("lamp", {"window", "lamps on the wall", "Amp", "LAMP"}) ==
        "are 'LAMP', 'Amp', 'window', 'lamps on the wall'");
  const std::vector<std::string> many(21, "lamp");
  CHECK(scene::listed_names(std::span(many).first(20)).ends_with("'lamp'"));
  CHECK(scene::listed_names(many).ends_with("'lamp' and 1 more"));
}

TEST_CASE("a direction towards a texel of an environment is its own, however the map is turned") {
  const double degrees = GENERATE(0.0, 50.0);
  constexpr int columns = 6, rows = 4;
  const EnvironmentMap map("sky", columns, rows, std::vector(columns * rows, glm::vec3(1)),
                           degrees);
  for (int texel = 0; texel < columns * rows; ++texel) {
    for (const double inside : {0.01, 0.99}) {
      const int row = texel / columns;
      CHECK(map.texel_towards(map.direction_at(texel % columns + inside, row, inside)) ==
            static_cast<std::size_t>(texel));
    }
  }
}

TEST_CASE("spot flux is the integral of its falloff over the sphere") {
  CHECK(scene::spot_flux(3.0, 0.0, 0.7853981634) ==
        Approx(integrated_spot_flux(3.0, 0.0, 0.7853981634)).epsilon(1e-6));
  CHECK(scene::spot_flux(3.0, 0.4, 1.2) ==
        Approx(integrated_spot_flux(3.0, 0.4, 1.2)).epsilon(1e-6));
}

TEST_CASE("a spot without a ramp over the half sphere has half the flux of a point light") {
  CHECK(2.0 * scene::spot_flux(5.0, pi / 2, pi / 2) == Approx(scene::point_flux(5.0)));
}

TEST_CASE("fluxes of area, point and directional lights are their closed forms") {
  CHECK(scene::area_flux(10.0, 2.0, false) == Approx(20.0 * pi));
  CHECK(scene::area_flux(10.0, 2.0, true) == Approx(40.0 * pi));
  CHECK(scene::point_flux(1.0) == Approx(4.0 * pi));
  CHECK(scene::directional_flux(1000.0, 3.0) == Approx(9000.0 * pi));
}

}  // namespace photile::test
