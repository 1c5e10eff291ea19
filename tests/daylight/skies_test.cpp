// The sun and skies of an hour.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"
#include "weather/perez_sky.hpp"
#include "weather/sky_patches.hpp"
#include "weather/weather_file.hpp"
#include "weather_text.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using std::numbers::pi;

// Skies of irradiances, against Radiance's gendaymtx and gendaylit.

const Site berlin{52.5, 13.4, 1};

/// What `gendaymtx -m 1 -c 1 1 1` (Radiance 6) makes of a line of a weather file: cd/m2 of patches,
/// counted from 1, and lux of the ground.
struct Reference {
  LocalTime time;
  weather::SkyIrradiance irradiance;
  double on_ground;
  std::map<std::size_t, double> sky;
  std::map<std::size_t, double> sun;
};
const Reference references[] = {
    {{2026, 6, 21, 14.0},
     {600, 120},
     4206.5 * pi / 0.2,
     {{1, 6014.4},
      {16, 7804.4},
      {31, 3418.9},
      {61, 2488.1},
      {85, 2165.9},
      {120, 22375.0},
      {139, 2953.5},
      {145, 3902.2}},
     {{100, 165933.0}, {120, 803710.0}, {121, 354420.0}, {135, 121362.0}}},
    {{2026, 12, 21, 11.5},
     {0, 40},
     300.72 * pi / 0.2,
     {{1, 1054.3},
      {16, 1274.5},
      {31, 1172.5},
      {61, 1319.2},
      {85, 1433.8},
      {100, 1560.9},
      {120, 1621.7},
      {139, 1627.1},
      {145, 1655.8}},
     {}},
    {{2026, 3, 21, 9.5},
     {300, 200},
     2344.9 * pi / 0.2,
     {{1, 5942.8},
      {16, 10471.5},
      {31, 5513.2},
      {61, 4761.4},
      {85, 4170.7},
      {100, 4797.2},
      {120, 4618.2},
      {139, 3812.7},
      {145, 4188.6}},
     {{42, 113486.0}, {43, 52805.0}, {69, 65156.0}, {70, 358000.0}}},
};

TEST_CASE("patches have the luminances that gendaymtx gives them") {
  const auto patches = weather::sky_patches(145);
  for (const Reference& reference : references) {
    const weather::SunPosition sun = weather::sun_position(berlin, reference.time);
    const weather::PerezSky sky(sun.elevation, reference.irradiance,
                                weather::day_of_year(reference.time));
    const auto luminances = weather::SkyInPatches(patches).luminances(sky, sun);
    for (const auto& [patch, luminance] : reference.sky) {
      INFO(reference.time.month << ", patch " << patch);
      // The suns stand up to a third of a degree apart, and gendaymtx prints three digits.
      CHECK(luminances[patch - 1] == Approx(luminance).epsilon(0.015));
    }
    const double on_ground =
        sky.diffuse_illuminance() + sky.direct_illuminance() * std::sin(sun.elevation);
    CHECK(on_ground == Approx(reference.on_ground).epsilon(0.02));
    if (reference.sun.empty()) {
      CHECK(sky.direct_illuminance() == 0);
      continue;
    }
    double sum = 0;
    for (const auto& [patch, luminance] : reference.sun)
      sum += luminance * patches[patch - 1].solid_angle();
    CHECK(sky.direct_illuminance() == Approx(sum).epsilon(0.01));
    const auto in_patches = weather::SkyInPatches(patches).sun(sun);
    REQUIRE_FALSE(in_patches.empty());
    for (const auto& [patch, share] : in_patches) {
      REQUIRE(reference.sun.count(patch + 1) == 1);
      const double luminance = share * sky.direct_illuminance() / patches[patch].solid_angle();
      CHECK(luminance == Approx(reference.sun.at(patch + 1)).epsilon(0.25).margin(5000));
    }
  }
}

TEST_CASE("clearness and brightness are gendaylit's") {
  const weather::SunPosition sun = weather::sun_position(berlin, {2026, 6, 21, 14.0});
  const weather::PerezSky sky(sun.elevation, {600, 120}, 172);
  CHECK(sky.clearness() == Approx(4.9711).epsilon(2e-3));
  CHECK(sky.brightness() == Approx(0.1121).epsilon(2e-3));
}

TEST_CASE("patches of a sky give the diffuse illuminance, however many there are") {
  const weather::SunPosition sun{2.0, 0.6};
  const weather::PerezSky sky(sun.elevation, {400, 150}, 100);
  for (const int count : weather::patch_counts) {
    const auto patches = weather::sky_patches(count);
    REQUIRE(patches.size() == static_cast<std::size_t>(count));
    const auto luminances = weather::SkyInPatches(patches).luminances(sky, sun);
    double solid_angle = 0, illuminance = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      solid_angle += patches[i].solid_angle();
      illuminance += luminances[i] * patches[i].solid_angle() * std::sin(patches[i].elevation);
    }
    CHECK(solid_angle == Approx(2 * pi));
    CHECK(illuminance == Approx(sky.diffuse_illuminance()));
    double shares = 0;
    for (const auto& share : weather::SkyInPatches(patches).sun(sun)) shares += share.share;
    CHECK(shares == Approx(1));
  }
}

TEST_CASE("the map of a Perez sky gives its lux, and is brightest around the sun") {
  const weather::SunPosition sun{1.0, 0.7};
  const weather::PerezSky sky(sun.elevation, {700, 90}, 180);
  const glm::dvec3 to_sun = weather::direction_of(sun.azimuth, sun.elevation);
  const EnvironmentMap map =
      loading::sky_map(SkyKind::perez, sky.diffuse_illuminance(), to_sun, &sky);
  double horizontal = 0;
  float brightest = 0;
  glm::dvec3 towards(0.0);
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      const glm::dvec3 direction = map.direction_at(column + 0.5, row, 0.5);
      const float luminance = map.texel(column, row).g;
      horizontal += double{luminance} * map.solid_angle(row) * std::max(0.0, direction.y);
      if (luminance > brightest) {
        brightest = luminance;
        towards = direction;
      }
    }
  }
  CHECK(horizontal == Approx(sky.diffuse_illuminance()).epsilon(1e-3));
  CHECK(glm::dot(towards, to_sun) > 0.999);
}

TEST_CASE("irradiances at the ends of the model leave finite, positive skies") {
  for (const double elevation : {-0.2, 0.0, 0.02, 1.0, pi / 2}) {
    for (const weather::SkyIrradiance& irradiance :
         {weather::SkyIrradiance{0, 0}, {0, 1}, {1, 0}, {1500, 1}, {1, 900}, {1000, 1000, -40}}) {
      const weather::PerezSky sky(elevation, irradiance, 1);
      const auto luminances =
          weather::SkyInPatches(weather::sky_patches(145)).luminances(sky, {1.0, elevation});
      for (const double luminance : luminances) {
        REQUIRE(std::isfinite(luminance));
        REQUIRE(luminance >= 0);
      }
      CHECK(std::isfinite(sky.direct_illuminance()));
      CHECK(sky.direct_illuminance() >= 0);
    }
  }
}

// Suns and skies by place, time and weather; skies of pictures by another hour.

constexpr double degrees = 180 / std::numbers::pi;

SceneLoadOptions in_berlin() {
  SceneLoadOptions options;
  options.situation.site = Site{52.5, 13.4, 1};
  options.situation.time = LocalTime{2026, 6, 21, 14.0};
  return options;
}

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

TEST_CASE("weather of an hour is lit by the sun of its middle, whatever time of it is asked for") {
  const TemporaryFolder folder;
  const auto file = folder.path / "year.epw";
  std::ofstream(file, std::ios::binary) << weather_text(
      [](int, int, int hour) { return 10 * hour; }, [](int, int, int hour) { return 100 + hour; });
  SceneLoadOptions options;
  options.situation.weather = file;
  const Site site = weather::read_weather(file).site;
  const auto middle = weather::sun_position(site, {2026, 6, 21, 9.5});
  // What a year of daylight takes: the irradiances of that row and the sun of its middle.
  const weather::PerezSky perez(middle.elevation, {100, 110, 5.5}, 172);
  for (const double hour : {9.2, 9.5, 10.0}) {
    CAPTURE(hour);
    options.situation.time = LocalTime{2026, 6, 21, hour};
    const loading::SkySituationLights lights = loading::sun_and_sky(options);
    REQUIRE((lights.sun && lights.sky));
    CHECK(lights.sun->elevation_degrees == Approx(middle.elevation * degrees));
    CHECK(lights.sun->azimuth_degrees == Approx(middle.azimuth * degrees));
    CHECK(lights.sun->illuminance == Approx(perez.direct_illuminance()));
    CHECK(lights.sky->illuminance == Approx(perez.diffuse_illuminance()));
  }
  const auto facts = loading::sky_facts(options);
  REQUIRE(facts.size() == 2);
  CHECK(facts[0] ==
        std::pair<std::string, std::string>("ground", "reflectance 0.2 below the horizon"));
  CHECK_THAT(facts[1].second, Contains("6/21 hour 10") && Contains("9:00 to 10:00") &&
                                  Contains("100 W/m2 direct") && Contains("110 W/m2 diffuse") &&
                                  Contains("sun stands where it is at 9:30"));
  // With a sky of its own the time places the sun.
  options.sky = Sky::parse("perez=600,120");
  const auto asked = weather::sun_position(site, {2026, 6, 21, 10.0});
  CHECK(loading::sun_and_sky(options).sun->elevation_degrees == Approx(asked.elevation * degrees));
  CHECK(loading::sky_facts(options).size() == 1);
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

// Where the sun stands, against an observatory's example and what geometry says.

constexpr double per_radian = 180 / std::numbers::pi;

/// The highest that the sun stands on a day, and where, in degrees.
weather::SunPosition highest(const Site& site, int month, int day) {
  weather::SunPosition best;
  for (int minute = 0; minute < 24 * 60; ++minute) {
    const weather::SunPosition at = weather::sun_position(site, {2026, month, day, minute / 60.0});
    if (minute == 0 || at.elevation > best.elevation) best = at;
  }
  return {best.azimuth * per_radian, best.elevation * per_radian};
}

TEST_CASE("the sun stands where the example of NREL's solar position algorithm has it") {
  // Reda and Andreas 2004: zenith 50.11162 with refraction (0.014 degrees), azimuth 194.34024.
  const weather::SunPosition sun = weather::sun_position(
      {39.742476, -105.1786, -7}, {2003, 10, 17, 12 + 30 / 60.0 + 30 / 3600.0});
  CHECK(sun.elevation * per_radian == Approx(90 - 50.11162 - 0.014).margin(0.02));
  CHECK(sun.azimuth * per_radian == Approx(194.34024).margin(0.02));
}

TEST_CASE("at noon of a solstice the sun is 23.44 degrees from where it is at an equinox") {
  for (const double latitude : {60.0, 35.0}) {
    const Site site{latitude, 0, 0};
    CHECK(highest(site, 6, 21).elevation == Approx(90 - latitude + 23.44).margin(0.02));
    CHECK(highest(site, 12, 21).elevation == Approx(90 - latitude - 23.44).margin(0.02));
    CHECK(highest(site, 6, 21).azimuth == Approx(180).margin(0.6));
  }
  // South of the tropic it culminates in the north.
  const double north = highest({-50, 0, 0}, 12, 21).azimuth;
  CHECK(std::min(north, 360 - north) < 0.6);
}

TEST_CASE("fifteen degrees to the west the same sun stands an hour later") {
  const weather::SunPosition here = weather::sun_position({50, 0, 0}, {2026, 4, 3, 9.0});
  const weather::SunPosition there = weather::sun_position({50, -15, 0}, {2026, 4, 3, 10.0});
  const weather::SunPosition by_zone = weather::sun_position({50, -15, -1}, {2026, 4, 3, 9.0});
  CHECK(there.elevation == Approx(here.elevation).margin(5e-4));
  CHECK(there.azimuth == Approx(here.azimuth).margin(5e-4));
  CHECK(by_zone.elevation == Approx(there.elevation).margin(1e-9));
}

TEST_CASE("in the morning the sun is in the east") {
  const weather::SunPosition sun = weather::sun_position({52.5, 13.4, 1}, {2026, 3, 20, 7.0});
  CHECK(sun.azimuth * per_radian == Approx(97).margin(4));
}

TEST_CASE("days count from the first of January") {
  CHECK(weather::day_of_year({2026, 1, 1}) == 1);
  CHECK(weather::day_of_year({2026, 3, 1}) == 60);
  CHECK(weather::day_of_year({2024, 12, 31}) == 366);
}

TEST_CASE("sites and times are read") {
  const Site site = Site::parse("52.5,13.4,1");
  CHECK(site.latitude_degrees == 52.5);
  CHECK(site.longitude_degrees == 13.4);
  CHECK(site.time_zone == 1);
  const LocalTime time = LocalTime::parse("2026-06-21T14:30");
  CHECK(time.month == 6);
  CHECK(time.day == 21);
  CHECK(time.hour == 14.5);
}

// The clear sky against another model, and its table by hand.

using weather::clear_sky;

constexpr double degree = std::numbers::pi / 180;

TEST_CASE("a clear sky is that of the table on the 21sts") {
  const auto june = clear_sky(30 * degree, 172);
  CHECK(june.direct_normal == Approx(1092 * std::exp(-0.185 / 0.5)));
  CHECK(june.diffuse_horizontal == Approx(0.137 * june.direct_normal));
  const auto january = clear_sky(90 * degree, 21);
  CHECK(january.direct_normal == Approx(1202 * std::exp(-0.141)));
  CHECK(clear_sky(-0.01, 172).direct_normal == 0);
  CHECK(clear_sky(0, 172).diffuse_horizontal == 0);
}

TEST_CASE("days between are between, the turn of the year too") {
  for (int day = 1; day < 365; ++day) {
    const double today = clear_sky(0.7, day).direct_normal;
    CHECK(std::abs(clear_sky(0.7, day + 1).direct_normal - today) < 3);
  }
  CHECK(clear_sky(0.7, 1).direct_normal ==
        Approx(clear_sky(0.7, 365).direct_normal).epsilon(0.005));
}

TEST_CASE("a clear sky gives open ground what Haurwitz measured, within 12%") {
  // Haurwitz, Insolation in relation to cloudiness and cloud density, J. Meteorology 2, 1945.
  for (const int day : {21, 80, 172, 264, 355}) {
    for (double elevation = 15; elevation <= 85; elevation += 10) {
      const double sine = std::sin(elevation * degree);
      const double measured = 1098 * sine * std::exp(-0.057 / sine);
      const auto sky = clear_sky(elevation * degree, day);
      CHECK(sky.direct_normal * sine + sky.diffuse_horizontal == Approx(measured).epsilon(0.12));
    }
  }
}

}  // namespace
}  // namespace photile::test
