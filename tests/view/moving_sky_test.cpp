// The sky of the window at any hour: against the sun's place and what reaches open ground.
#include "view/moving_sky.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/files.hpp"
#include "loading/light_changes.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "temporary_folder.hpp"
#include "test_scenes.hpp"
#include "weather/perez_sky.hpp"
#include "weather_text.hpp"

namespace photile::test {
namespace {

using namespace photile::view;

constexpr double degrees = 180 / std::numbers::pi;
const Site berlin{52.5, 13.4, 1};

/// A scene's patches, after a lamp, each of 1 lm at 1 cd/m2.
LightMix sky_mix(int patches = 145) {
  LightMix mix;
  mix.lights.resize(1);
  mix.lights[0].name = "lamp";
  for (std::size_t i = 0; i <= static_cast<std::size_t>(patches); ++i) {
    MixedLight& light = mix.lights.emplace_back();
    light.name = loading::sky_light_name(i, static_cast<std::size_t>(patches));
    light.power = 1;
  }
  return mix;
}

double horizontal(const std::vector<double>& luminances) {
  const auto patches = weather::sky_patches(145);
  double sum = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    sum += luminances[i] * patches[i].solid_angle() * std::sin(patches[i].elevation);
  }
  return sum;
}

}  // namespace

TEST_CASE("hours pass midnight and days the end of the year") {
  SkyMoment moment{1, 0.5};
  moment.add_hours(-1);
  CHECK(moment.day == 365);
  CHECK(moment.hour == Approx(23.5));
  CHECK(day_text(moment) + hour_text(moment) == "31 December23:30");
  moment.add_hours(49);
  CHECK(day_text(moment) + hour_text(moment) == "3 January00:30");
  moment.add_days(-30);
  CHECK(day_text(moment) + hour_text(moment) == "4 December00:30");
  CHECK(day_text(SkyMoment::of({2028, 2, 29, 14.25})) +
            hour_text(SkyMoment::of({2028, 2, 29, 14.25})) ==
        "28 February14:15");
  const LocalTime time = SkyMoment{172, 12}.time();
  CHECK((time.month == 6 && time.day == 21 && time.hour == 12));
}

TEST_CASE("the patches shine where the sun is, and give open ground what the weather says") {
  const auto sky = MovingSky::of(sky_mix(), {.site = berlin});
  REQUIRE(sky);
  REQUIRE(sky->lights().size() == 146);
  CHECK(sky->lights().front() == 1);  // after the lamp
  for (const SkyMoment moment : {SkyMoment{172, 9}, SkyMoment{172, 17}, SkyMoment{300, 12}}) {
    const auto powers = sky->powers(moment);
    const auto patches = weather::sky_patches(145);
    const auto brightest = static_cast<std::size_t>(
        std::max_element(powers.begin(), powers.end() - 1) - powers.begin());
    const weather::SunPosition sun = weather::sun_position(berlin, moment.time());
    const glm::dvec3 to_sun = weather::direction_of(sun.azimuth, sun.elevation);
    const glm::dvec3 to_patch =
        weather::direction_of(patches[brightest].azimuth, patches[brightest].elevation);
    CHECK(degrees * std::acos(glm::dot(to_sun, to_patch)) < 9);  // half a patch's diagonal
    const weather::PerezSky perez(sun.elevation, weather::clear_sky(sun.elevation, moment.day),
                                  moment.day);
    CHECK(horizontal(powers) ==
          Approx(perez.diffuse_illuminance() + perez.direct_illuminance() * std::sin(sun.elevation))
              .epsilon(0.06));
  }
}

TEST_CASE("at night nothing shines, and the window says so") {
  const auto sky = MovingSky::of(sky_mix(), {.site = berlin});
  const SkyMoment midnight{172, 0};
  const auto powers = sky->powers(midnight);
  CHECK(std::accumulate(powers.begin(), powers.end(), 0.0) == 0);
  // 90 - 52.5 - 23.4 degrees, and a few minutes of time off.
  CHECK_THAT(sky->text(midnight), Catch::Contains("night: the sun is 14 degrees below"));
  CHECK_THAT(sky->text({172, 12}), Catch::Contains("61 degrees high in the south"));
}

TEST_CASE("the weather of a file lights its own place, in watts by the efficacy") {
  TemporaryFolder folder;
  const auto file = folder.path / "year.epw";
  write_file(file,
             weather_text([](int, int, int) { return 0; }, [](int, int, int) { return 100; }));
  LightMix mix = sky_mix();
  for (MixedLight& light : mix.lights) light.unit = PowerUnit::watt;
  mix.lumen_per_watt = 100;
  const auto sky = MovingSky::of(mix, {.weather = file});
  REQUIRE(sky);
  const SkyMoment noon{172, 12};
  CHECK(sky->irradiance(noon).diffuse_horizontal == 100);
  const auto place = weather::read_weather(file).site;
  const SkyMoment middle{172, 11.5};  // of the hour whose row holds for noon
  CHECK(sky->sun(noon).elevation == weather::sun_position(place, middle.time()).elevation);
  const weather::PerezSky perez(weather::sun_position(place, middle.time()).elevation,
                                sky->irradiance(noon), noon.day);
  CHECK(100 * horizontal(sky->powers(noon)) == Approx(perez.diffuse_illuminance()).epsilon(1e-6));
}

TEST_CASE("a place makes a sky of patches, unless another sky or sun is asked for") {
  SceneLoadOptions options;
  options.situation = {.site = berlin, .north_degrees = 30};
  options.situation.time = LocalTime{2026, 6, 21, 9};
  SceneLoadOptions overcast = options, sunny = options, nowhere;
  const SkySituation taken = take_moving_sky(options);
  CHECK(taken.site);
  REQUIRE(taken.time);
  CHECK(SkyMoment::of(*taken.time) == SkyMoment{172, 9});
  REQUIRE(options.sky);
  CHECK((options.sky->kind == SkyKind::patches && options.sky->patches == 145));
  CHECK((!options.situation.site && !options.situation.time));
  CHECK(options.situation.north_degrees == 30);
  overcast.sky = Sky::parse("overcast=10000");
  CHECK(!take_moving_sky(overcast).site);
  CHECK(overcast.situation.time);
  sunny.sun = Sun::parse("80000");
  CHECK(!take_moving_sky(sunny).site);
  CHECK((!take_moving_sky(nowhere).site && !nowhere.sky));
  nowhere.sky = Sky::parse("patches=577");
  CHECK(!take_moving_sky(nowhere).site);
  CHECK(nowhere.sky->patches == 577);
  Scene floor = plate(diffuse(glm::vec3(0.5f)), 1);
  loading::add_surroundings(floor, nowhere);
  loading::group_lights(floor, nowhere.light_groups);
  CHECK(light_groups_of(floor).groups.size() == 1);
  CHECK(!MovingSky::of(sky_mix(577), {}));  // no place
  CHECK(!MovingSky::of(sky_mix(100), {.site = berlin}));
}

}  // namespace photile::test
