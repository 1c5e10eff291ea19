// Skies of irradiances, against Radiance's gendaymtx and gendaylit.
#include "weather/perez_sky.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "loading/surroundings.hpp"
#include "weather/sky_patches.hpp"

namespace photile::test {

using namespace photile::daylight;

namespace {

using std::numbers::pi;
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

}  // namespace

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

}  // namespace photile::test
