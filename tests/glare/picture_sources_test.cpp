// Sources in pictures whose light is known in closed form.
#include "glare/picture_sources.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

namespace photile::test {
namespace {

using namespace photile::glare;

LuminancePicture picture_of(int side, const std::function<double(const glm::dvec3&)>& luminance) {
  LuminancePicture picture{side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double value = picture.solid_angle(x, y) > 0 ? luminance(picture.direction(x, y)) : 0;
      picture.luminance.push_back(static_cast<float>(value));
    }
  }
  return picture;
}

/// A cone of half angle `radius` around a direction.
bool in_cone(const glm::dvec3& direction, const glm::dvec3& axis, double radius) {
  return std::acos(glm::dot(direction, axis)) < radius;
}

glm::dvec3 at(double right, double up) {
  return glm::normalize(glm::dvec3(std::tan(right), std::tan(up), 1));
}

}  // namespace

TEST_CASE("pixels of the angular projection cover the hemisphere") {
  const LuminancePicture picture = picture_of(400, [](const glm::dvec3&) { return 1.0; });
  double whole = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) whole += picture.solid_angle(x, y);
  }
  CHECK(whole == Approx(2 * glm::pi<double>()).epsilon(0.002));
  // The middle of the right border: 90 degrees less half a pixel.
  const glm::dvec3 right = picture.direction(399, 200);
  CHECK(std::acos(right.z) == Approx(0.5 * glm::pi<double>() * (1 - 1.0 / 400)).epsilon(1e-3));
  CHECK(right.x > 0.99);
  CHECK(picture.direction(200, 0).y > 0.99);
  CHECK(picture.solid_angle(0, 0) == 0);
}

TEST_CASE("an even picture has no source, and glm::pi<double>() L at the eye") {
  const PictureGlare glare =
      find_sources(picture_of(300, [](const glm::dvec3&) { return 1500.0; }));
  CHECK(glare.sources.empty());
  CHECK(glare.illuminance == Approx(1500 * glm::pi<double>()).epsilon(0.003));
  CHECK(glare.background == Approx(1500).epsilon(0.003));
}

TEST_CASE("a cone of light is a source with its solid angle, luminance and position index") {
  const double radius = 0.08;
  const glm::dvec3 axis = at(0.3, 0.4);
  const PictureGlare glare = find_sources(picture_of(800, [&](const glm::dvec3& direction) {
    return in_cone(direction, axis, radius) ? 9000.0 : 100.0;
  }));
  REQUIRE(glare.sources.size() == 1);
  const PictureSource& found = glare.sources.front();
  const double solid_angle = 2 * glm::pi<double>() * (1 - std::cos(radius));
  CHECK(found.source.solid_angle == Approx(solid_angle).epsilon(0.02));
  CHECK(found.source.luminance == Approx(9000));
  CHECK(glm::dot(found.direction, axis) == Approx(1).margin(1e-5));
  const Observer ahead{"", glm::dvec3(0), {0, 0, 1}, {0, 1, 0}};
  CHECK(found.source.position_index == Approx(position_index(ahead, axis)).epsilon(0.01));
  // A cone's illuminance is pi L sin^2 times the cosine of its axis.
  const double direct = glm::pi<double>() * 9000 * std::pow(std::sin(radius), 2) * axis.z;
  CHECK(glare.illuminance - glm::pi<double>() * glare.background == Approx(direct).epsilon(0.02));
  CHECK(glare.background == Approx(100).epsilon(0.05));
}

TEST_CASE("pixels within the angle are one source, beyond it two") {
  const double gap = GENERATE(0.06, 0.16);
  const PictureGlare glare = find_sources(picture_of(600, [&](const glm::dvec3& direction) {
    const double side = 0.5 * gap + 0.05;  // cones of 0.05 radians with the gap between
    return in_cone(direction, at(side, 0), 0.05) || in_cone(direction, at(-side, 0), 0.05) ? 5000.0
                                                                                           : 50.0;
  }));
  CHECK(glare.sources.size() == (gap < defaults::glare_source_angle ? 1 : 2));
}

TEST_CASE("peaks are sources of their own within a source") {
  const PictureGlare glare = find_sources(picture_of(600, [&](const glm::dvec3& direction) {
    if (in_cone(direction, at(0, 0.2), 0.03)) return 1e6;
    return in_cone(direction, at(0, 0.2), 0.2) ? 6000.0 : 50.0;
  }));
  REQUIRE(glare.sources.size() == 2);
  CHECK(glare.sources[0].source.luminance == Approx(1e6));
  CHECK(glare.sources[0].source.solid_angle ==
        Approx(2 * glm::pi<double>() * (1 - std::cos(0.03))).epsilon(0.1));
  CHECK(glare.sources[1].source.luminance == Approx(6000));
}

TEST_CASE("a threshold up to 100 counts in mean luminances, and an index is at most 16") {
  const auto picture = picture_of(400, [&](const glm::dvec3& direction) {
    return in_cone(direction, at(0, 1.4), 0.1) ? 900.0 : 10.0;
  });
  CHECK(find_sources(picture).sources.empty());
  const PictureGlare glare = find_sources(picture, {.threshold = 5});
  REQUIRE(glare.sources.size() == 1);
  CHECK(glare.sources.front().source.position_index == defaults::largest_position_index);
}

}  // namespace photile::test
