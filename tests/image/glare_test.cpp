// Which reflections are marked.
#include "image/glare.hpp"

#include <catch2/catch.hpp>

#include "photile/errors.hpp"
#include "two_lights.hpp"

namespace photile::test {

using namespace photile::image;

namespace {

/// Two lights over four pixels, whose pictures are even at `radiance` and power 1.
LightLayers even(float a, float b) {
  LightLayers layers(4, 1, {"a", "b"});
  layers.layers[0].radiance.assign(4, glm::vec3(a));
  layers.layers[1].radiance.assign(4, glm::vec3(b));
  return layers;
}

LightMix mix_of(double a, double b) { return test::two_lights("a", a, "b", b); }

}  // namespace

TEST_CASE("a limit up to 100 counts in mean luminances of the picture, above in cd/m2") {
  const LightLayers none = even(0, 0);
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 5).limit == Approx(5 * 320));
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 100).limit == Approx(100 * 320));
  CHECK(find_glare(even(2, 3), none, mix_of(10, 100), 101).limit == 101);
}

TEST_CASE("each pixel is marked with the light whose reflection is brightest above the limit") {
  LightLayers reflections = even(0, 0);
  reflections.layers[0].radiance[0] = glm::vec3(300);  // x 1: above
  reflections.layers[1].radiance[0] = glm::vec3(400);  // x 0.5: above, but less
  reflections.layers[1].radiance[1] = glm::vec3(500);  // x 0.5: above
  reflections.layers[0].radiance[2] = glm::vec3(199);  // below
  const Glare glare = find_glare(even(1, 1), reflections, mix_of(1, 0.5), 199.5);
  CHECK(glare.marks == std::vector<int>{0, 1, -1, -1});
  CHECK(glare.lights[0].share == Approx(0.25));
  CHECK(glare.lights[1].share == Approx(0.5));
  CHECK(glare.lights[0].peak == Approx(300));
  CHECK(glare.lights[1].peak == Approx(250));
  CHECK(glare_lines(glare, PowerUnit::lumen).size() == 2);
}

TEST_CASE("marks have their light's colour, the rest is dimmed") {
  std::vector<std::uint8_t> rgb{200, 100, 50, 1, 2, 3};
  draw_marks({-1, 1}, rgb);
  const auto colour = mark_colour(1);
  CHECK(rgb == std::vector<std::uint8_t>{100, 50, 25, colour[0], colour[1], colour[2]});
  CHECK(mark_colour(0) != mark_colour(6));
  CHECK(mark_colour(0) == mark_colour(7));
}

TEST_CASE("glare of pictures of different sizes is refused") {
  CHECK_THROWS_AS(find_glare(even(1, 1), LightLayers(2, 2, {"a", "b"}), mix_of(1, 1), 5),
                  UsageError);
}

}  // namespace photile::test
