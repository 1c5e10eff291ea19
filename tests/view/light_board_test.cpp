// What the sliders make of the lamps.
#include "tools/view/light_board.hpp"

#include <catch2/catch.hpp>

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

}  // namespace photile::test
