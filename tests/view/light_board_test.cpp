// What the sliders make of the lamps.
#include "view/light_board.hpp"

#include <catch2/catch.hpp>

#include "loading/surroundings.hpp"
#include "two_lights.hpp"

namespace photile::test {

using view::LightBoard;

namespace {

/// Two lamps of 100 and 300 lm: a white one and one that emits no blue.
LightMix two_lamps() {
  LightMix mix = test::two_lights("ceiling", 100, "sodium", 300);
  mix.lights[1].color = {1.3f, 0.9f, 0.0f};
  return mix;
}

std::vector<std::string> sky_light_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i <= 145; ++i) names.push_back(loading::sky_light_name(i, 145));
  return names;
}

}  // namespace

TEST_CASE("the board begins as the scene says, and goes back to it") {
  LightBoard board(two_lamps());
  CHECK(board.mix().lights[0].power == 100);
  board.controls()[0].power = 7;
  board.controls()[1].on = false;
  CHECK(board.mix().lights[0].power == 7);
  CHECK(board.mix().lights[1].power == 0);
  board.reset();
  CHECK(board.mix().lights[0].power == 100);
  CHECK(board.mix().lights[1].power == 300);
}

TEST_CASE("a light that is solo is lit alone, even one that is off") {
  LightBoard board(two_lamps());
  board.controls()[1].solo = true;
  board.controls()[1].on = false;
  CHECK(board.mix().lights[0].power == 0);
  CHECK(board.mix().lights[1].power == 300);
}

TEST_CASE("a colour keeps a light's luminance") {
  LightBoard board(two_lamps());
  board.controls()[0].color = glm::vec3(1, 0.5f, 0.25f);
  const MixedLight light = board.mix().lights[0];
  CHECK(light.tint.r > light.tint.b);
  CHECK(luminance(glm::dvec3(light.tint) * glm::dvec3(light.color)) == Approx(1));
  CHECK(board.refused().empty());
}

TEST_CASE("a colour that a light cannot have is told and leaves it as it was") {
  LightBoard board(two_lamps());
  board.controls()[1].color = glm::vec3(0, 0, 1);
  CHECK(board.refused() == std::vector<std::string>{"sodium"});
  CHECK(board.mix().lights[1].tint == glm::vec3(1));
}

TEST_CASE("a colour temperature tints as --light NAME=KELVINK does, in place of a colour") {
  LightBoard board(two_lamps());
  board.controls()[0].kelvin = 2700;
  LightMix expected = two_lamps();
  change_lights(expected, {{"ceiling", "2700K"}});
  CHECK(board.mix().lights[0].tint == expected.lights[0].tint);
  CHECK(board.mix().lights[0].tint.r > board.mix().lights[0].tint.b);
  CHECK(board.mix().lights[0].power == 100);
  board.controls()[1].kelvin = 6500;  // of which the lamp lacks the blue
  CHECK(board.refused() == std::vector<std::string>{"sodium"});
  board.reset();
  CHECK_FALSE(board.controls()[0].tinted());
}

TEST_CASE("patches of a sky are one layer beside the lamps, at the powers of the moment") {
  LightMix mix = two_lamps();
  for (const std::string& name : sky_light_names()) {
    MixedLight& light = mix.lights.emplace_back();
    light.name = name;
    light.power = 3;
  }
  std::swap(mix.lights[1], mix.lights[40]);  // lamps may stand anywhere
  LightBoard board(mix, view::MovingSky::of(mix, {.site = Site{52.5, 13.4, 1}}));
  REQUIRE(board.sky());
  REQUIRE(board.controls().size() == 2);
  CHECK(board.controls()[1].name == "sodium");
  board.controls()[1].power = 7;
  const LightMix all = board.mix(), shown = board.shown_mix();
  const LayerMixdown mixdown = board.mixdown();
  REQUIRE(mixdown.layers == std::vector<std::string>{"ceiling", "sodium", "sky"});
  REQUIRE(shown.lights.size() == 3);
  CHECK(all.lights[40].power == 7);
  // Layers at their shown powers sum to lights at theirs.
  for (std::size_t light = 0; light < all.lights.size(); ++light) {
    const std::uint32_t layer = mixdown.layer_of[light];
    CHECK(static_cast<double>(mixdown.scale[light]) * shown.lights[layer].power ==
          Approx(all.lights[light].power));
  }
  CHECK(board.lamps_mix().lights[50].power == 3);
  board.controls()[0].solo = true;
  CHECK(board.mix().lights[50].power == 0);
  CHECK(board.shown_mix().lights[2].power == 0);
  board.controls()[0].solo = false;
  board.daylight().on = false;
  CHECK(board.shown_mix().lights[2].power == 0);
  CHECK(board.shown_mix().lights[0].power == 100);
}

TEST_CASE("settings stay with the names of lights when the scene gets others") {
  LightBoard board(two_lamps());
  board.controls()[0].power = 7;
  board.controls()[1].on = false;
  LightMix other = test::two_lights("ceiling", 200, "spot", 40);
  board.adopt(other, nullptr);
  REQUIRE(board.controls().size() == 2);
  CHECK(board.mix().lights[0].power == 7);
  CHECK(board.controls()[0].scene_power == 200);
  CHECK(board.mix().lights[1].power == 40);
  other.lights[1].power = 80;  // of the file, and set by nobody
  board.adopt(other, nullptr);
  CHECK(board.mix().lights[1].power == 80);
  board.adopt(two_lamps(), nullptr);  // what was gone returns as it was
  CHECK(board.controls()[1].name == "sodium");
  CHECK_FALSE(board.controls()[1].on);
  LightBoard before(test::two_lights("ceiling", 100, "desk", 1));
  board.take_settings(before);
  CHECK(board.mix().lights[0].power == 100);
  CHECK_FALSE(board.controls()[1].on);  // which the other board does not know
}

}  // namespace photile::test
