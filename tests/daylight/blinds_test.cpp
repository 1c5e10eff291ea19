// Blinds: panes that let less through, and hours in which they close, by hand.
#include <catch2/catch.hpp>
#include <numbers>

#include "daylight/sky_states.hpp"
#include "photile/errors.hpp"
#include "room_with_window.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {

using namespace photile::daylight;
using Catch::Contains;
using Room = RoomWithWindow;

namespace {

using std::numbers::pi;

Material pane(const std::string& name) {
  Material material;
  material.name = name;
  material.interaction = Interaction::glass;
  material.thin = true;
  material.index_of_refraction = 1.5f;
  return material;
}

}  // namespace

TEST_CASE("a window group closes where more than 2% of the points have sun of 1,000 lux") {
  // 100 points, 4 hours: no sun, sun on 2 points, on 3 points, on 3 points through closed blinds.
  constexpr std::size_t sensors = 100, hours = 4;
  std::vector<std::vector<float>> sun(2, std::vector<float>(sensors * hours, 0.0f));
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    if (sensor < 2) sun[0][sensor * hours + 1] = 50'000;
    sun[0][sensor * hours + 2] = 1'000;
    sun[0][sensor * hours + 3] = sun[1][sensor * hours + 3] = 20'000;
  }
  const std::vector<int> closed{0, 1};
  CHECK(blind_schedule(sun, closed, sensors, hours) == std::vector<std::size_t>{0, 0, 1, 1});
}

TEST_CASE("of several groups as few close as keep the sun out") {
  // Hours with sun through neither, the first, the second and both of two groups.
  std::vector<std::vector<float>> sun{
      {0, 2000, 2000, 2000}, {0, 0, 2000, 2000}, {0, 2000, 0, 2000}, {0, 0, 0, 0}};
  const std::vector<int> closed{0, 1, 1, 2};
  CHECK(blind_schedule(sun, closed, 1, 4) == std::vector<std::size_t>{0, 1, 2, 3});
}

TEST_CASE("a closed pane lets through what is asked for") {
  SceneBuilder builder = Room::builder(diffuse(glm::vec3(0.0f)));
  const auto glass = builder.add(pane("glazing"));
  builder.quad({Room::left, Room::sill, 0}, {Room::right, Room::sill, 0},
               {Room::right, Room::head, 0}, {Room::left, Room::head, 0}, glass);
  Scene scene = builder.build();
  scene.portals = {Room::window()};
  Year year{{}, weather::sky_patches(145), {{{1.8, 1.4, 3.0}, {0, 0, -1}}}, false, {}};
  year.parameters.measuring.gathering.rays = 256;
  year.parameters.measuring.repeats = 4;
  year.parameters.mean_luminance.assign(146, 1.0);
  const std::vector<BlindGroup> groups{BlindGroup::parse("glaz*=0.05")};
  const auto states = sky_states(year, scene, groups, Progress::none());
  REQUIRE(states.size() == 2);
  CHECK(states[0].name == "open");
  CHECK(states[1].name == "closed");
  const double bare =
      pi * validation::rectangle_factor(year.sensors[0].position, year.sensors[0].normal,
                                        {Room::left, Room::sill, 0}, {1.2, 0, 0}, {0, 1, 0});
  const auto all = [&](const SkyState& state) {
    double sum = 0;
    for (std::size_t patch = 0; patch < state.matrix.patches; ++patch)
      sum += state.matrix.coefficient(0, patch);
    return sum;
  };
  // Both faces of glass of index 1.5 together reflect 7.7% of light at normal incidence.
  CHECK(all(states[0]) == Approx(bare * 0.923).epsilon(0.02));
  CHECK(all(states[1]) == Approx(bare * 0.05).epsilon(0.02));
}

TEST_CASE("blinds are refused in a line where they cannot be") {
  CHECK_THROWS_WITH(BlindGroup::parse("glass"), Contains("--blinds glass"));
  CHECK_THROWS_WITH(BlindGroup::parse("glass=2"), Contains("--blinds glass=2"));
  SceneBuilder builder = Room::builder(diffuse(glm::vec3(0.0f)));
  builder.add(pane("glazing"));
  const Scene scene = builder.build();
  const auto close = [&](const char* text) {
    const std::vector<BlindGroup> groups{BlindGroup::parse(text)};
    return materials_with(scene, groups, 1);
  };
  CHECK_THROWS_WITH(close("window=0.1"), Contains("there is no such material"));
  CHECK_THROWS_WITH(close("glazing=0.95"), Contains("lets 0.923 through"));
  CHECK_THROWS_WITH(close("*=0.1"), Contains("is no thin pane"));
}

}  // namespace photile::test
