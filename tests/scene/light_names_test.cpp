#include "scene/light_names.hpp"

#include <catch2/catch.hpp>

#include "photile/limits.hpp"

namespace photile::test {
namespace {

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

}  // namespace
}  // namespace photile::test
