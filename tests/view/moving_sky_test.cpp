// Which skies of a live page follow the hour.
#include "view/moving_sky.hpp"

#include <catch2/catch.hpp>

#include "loading/light_changes.hpp"
#include "loading/surroundings.hpp"
#include "test_scenes.hpp"

namespace photile::test {

using view::take_moving_sky;

TEST_CASE("a place makes a sky of patches, unless another sky or sun is asked for") {
  SceneLoadOptions options;
  options.situation = {.site = Site{52.5, 13.4, 1}, .north_degrees = 30};
  options.situation.time = LocalTime{2026, 6, 21, 9};
  SceneLoadOptions overcast = options, sunny = options, nowhere;
  const SkySituation taken = take_moving_sky(options);
  CHECK(taken.site);
  REQUIRE(taken.time);
  CHECK(taken.time->month == 6);
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
}

}  // namespace photile::test
