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

TEST_CASE("the board begins as the scene says") {
  LightBoard board(two_lamps());
  CHECK(board.mix().lights[0].power == 100);
  board.controls()[0].power = 7;
  board.controls()[1].on = false;
  CHECK(board.mix().lights[0].power == 7);
  CHECK(board.mix().lights[1].power == 0);
}

TEST_CASE("a colour keeps a light's luminance") {
  LightBoard board(two_lamps());
  board.controls()[0].color = glm::vec3(1, 0.5f, 0.25f);
  const MixedLight light = board.mix().lights[0];
  CHECK(light.tint.r > light.tint.b);
  CHECK(luminance(glm::dvec3(light.tint) * glm::dvec3(light.color)) == Approx(1));
}

TEST_CASE("a colour that a light cannot have leaves it as it was") {
  LightBoard board(two_lamps());
  board.controls()[1].color = glm::vec3(0, 0, 1);
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
  CHECK(board.mix().lights[1].tint == glm::vec3(1));
}

TEST_CASE("patches of a sky have no controls") {
  LightMix mix = two_lamps();
  for (const std::string& name : sky_light_names()) {
    MixedLight& light = mix.lights.emplace_back();
    light.name = name;
    light.power = 3;
  }
  std::swap(mix.lights[1], mix.lights[40]);  // lamps may stand anywhere
  LightBoard board(mix);
  REQUIRE(board.controls().size() == 2);
  CHECK(board.controls()[1].name == "sodium");
  board.controls()[1].power = 7;
  CHECK(board.mix().lights[40].power == 7);
  CHECK(board.mix().lights[50].power == 3);
}

}  // namespace photile::test
