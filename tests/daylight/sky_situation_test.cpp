// Suns and skies by place, time and weather; skies of pictures by another hour.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"

namespace photile::test {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

SceneLoadOptions in_berlin() {
  SceneLoadOptions options;
  options.situation.site = Site{52.5, 13.4, 1};
  options.situation.time = LocalTime{2026, 6, 21, 14.0};
  return options;
}

}  // namespace

TEST_CASE("a Perez sky brings its sun, which north turns") {
  SceneLoadOptions options = in_berlin();
  options.sky = Sky::parse("perez=600,120");
  const loading::SkySituationLights plain = loading::sun_and_sky(options);
  const auto position = weather::sun_position(*options.situation.site, *options.situation.time);
  REQUIRE(plain.sun);
  REQUIRE(plain.sky);
  CHECK(plain.sun->azimuth_degrees == Approx(position.azimuth * degrees));
  CHECK(plain.sun->elevation_degrees == Approx(position.elevation * degrees));
  // gendaylit -W 600 120 at this hour: 5.085e6 x 179 cd/m2 over a disc of 0.533 degrees.
  const double disc = std::numbers::pi * std::pow(0.533 / 2 / degrees, 2);
  CHECK(plain.sun->illuminance == Approx(5.085e6 * 179 * disc).epsilon(0.01));
  options.situation.north_degrees = 30;
  const loading::SkySituationLights turned = loading::sun_and_sky(options);
  CHECK(turned.sun->azimuth_degrees == Approx(plain.sun->azimuth_degrees + 30));
  CHECK(turned.sky->to_sun.x ==
        Approx(std::sin(position.azimuth + 30 / degrees) * std::cos(position.elevation)));
}

TEST_CASE("at night a Perez sky has no sun") {
  SceneLoadOptions options = in_berlin();
  options.situation.time->hour = 1;
  options.sky = Sky::parse("perez=600,120");
  CHECK(!loading::sun_and_sky(options).sun);
  options.sky = Sky::parse("perez=0,0");
  CHECK(!loading::sun_and_sky(options).sky);
}

TEST_CASE("a sun of its lux alone stands where the time says") {
  SceneLoadOptions options = in_berlin();
  options.sun = Sun::parse("80000");
  options.sky = Sky::parse("clear=10000");
  const loading::SkySituationLights lights = loading::sun_and_sky(options);
  REQUIRE(lights.sun);
  CHECK(lights.sun->illuminance == 80'000);
  CHECK(lights.sun->elevation_degrees > 40);
  options.situation = {};
  CHECK_THROWS_AS(loading::sun_and_sky(options), UsageError);
}

TEST_CASE("options of a situation that lack another are refused") {
  const auto refused = [](const std::function<void(SceneLoadOptions&)>& change) {
    SceneLoadOptions options = in_berlin();
    change(options);
    CHECK_THROWS_AS(loading::sun_and_sky(options), UsageError);
  };
  refused([](auto& o) { o.situation.site.reset(); });
  refused([](auto& o) { o.situation.time.reset(); });
  refused([](auto& o) { o.sun = Sun::parse("135,40,1000"); });
  refused([](auto& o) {
    o.situation = {};
    o.sky = Sky::parse("perez=1,1");
  });
  for (const char* text :
       {"perez=1", "perez=-1,2", "perez=1,2,3", "perez=a,b", "patches=144", "patches=2305.5"})
    CHECK_THROWS_AS(Sky::parse(text), UsageError);
}

TEST_CASE("patches of a picture take the luminances of another hour") {
  LightMix mix;
  const auto patches = weather::sky_patches(145);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    MixedLight light;
    light.name = weather::patch_name(i);
    light.power = 1;
    mix.lights.push_back(light);
  }
  MixedLight lamp;
  lamp.name = "lamp";
  mix.lights.push_back(lamp);
  const SceneLoadOptions options = in_berlin();
  const auto changes =
      loading::sky_changes(mix, options.situation, Sky{SkyKind::perez, 0, 600, 120});
  REQUIRE(changes.size() == patches.size());
  double horizontal = 0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    REQUIRE(changes[i].name == mix.lights[i].name);
    horizontal += std::stod(changes[i].value.substr(1)) * patches[i].solid_angle() *
                  std::sin(patches[i].elevation);
  }
  // gendaymtx of this hour and place: the ground, of reflectance 0.2, has 4206.5 cd/m2.
  CHECK(horizontal == Approx(4206.5 * std::numbers::pi / 0.2).epsilon(0.05));
  mix.lights.erase(mix.lights.begin());
  CHECK_THROWS_AS(loading::sky_changes(mix, options.situation, Sky{SkyKind::perez, 0, 600, 120}),
                  UsageError);
}

}  // namespace photile::test
