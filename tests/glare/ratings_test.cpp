// Ratings of glare, and what they are made from.
#include "glare/ratings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "glare/measure_glare.hpp"
#include "glare/picture_sources.hpp"

namespace photile::test {
namespace {

using namespace glare;

// The formulas of glare against numbers worked out by hand and published values.

const Observer ahead{"eye", glm::dvec3(0), {0, 1, 0}, {0, 0, 1}};

/// The position index of a luminaire R ahead, T aside and H above.
double index_at(double t_over_r, double h_over_r) {
  return position_index(ahead, glm::normalize(glm::dvec3(t_over_r, 1, h_over_r)));
}

TEST_CASE("the position index has the values of CIE 117, table 4.1") {
  struct Cell {
    double t, h, p;
  };
  for (const Cell& cell :
       {Cell{0, 0, 1.0}, Cell{0, 0.5, 2.86}, Cell{0, 1, 7.0}, Cell{0, 1.5, 13.15},
        Cell{0.5, 0, 1.43}, Cell{0.5, 0.5, 2.91}, Cell{0.5, 1, 6.4}, Cell{1, 0, 2.11},
        Cell{1, 0.5, 3.91}, Cell{1, 1, 7.0}, Cell{1, 1.5, 11.9}, Cell{2, 1, 8.9}}) {
    CAPTURE(cell.t, cell.h);
    CHECK(index_at(cell.t, cell.h) == Approx(cell.p).epsilon(0.08));  // a formula for a drawn table
    CHECK(index_at(-cell.t, cell.h) == index_at(cell.t, cell.h));
  }
}

TEST_CASE(
    "the position index is continuous across the line of sight, and infinite behind the eyes") {
  CHECK(index_at(0.7, 1e-7) == Approx(index_at(0.7, -1e-7)).epsilon(1e-3));
  // Straight below: tan beta = tan sigma sqrt(1.3225) = 1.15.
  const double beta = std::atan(1.15) * 180 / glm::pi<double>();
  CHECK(index_at(0, -1) == Approx(std::exp(6.49e-3 * beta + 21e-5 * beta * beta)));
  CHECK(std::isinf(position_index(ahead, {0, -1, 0})));
  CHECK(std::isinf(position_index(ahead, {1, 0, 0})));
}

TEST_CASE("UGR of one source is 8 log10 (0.25 L^2 omega / (L_b p^2))") {
  const Source source{10'000, 0.01, 2};
  CHECK(ugr(std::span(&source, 1), 50) == Approx(8 * std::log10(0.25 * 1e8 * 0.01 / (50 * 4))));
  // Two of them are 8 log10 2 worse, a background ten times as bright 8 better.
  const Source two[]{source, source};
  CHECK(ugr(two, 50) == Approx(ugr(std::span(&source, 1), 50) + 8 * std::log10(2)));
  CHECK(ugr(two, 500) == Approx(ugr(two, 50) - 8));
  CHECK(ugr({}, 50) == -INFINITY);
}

TEST_CASE("a small source counts 200 I^2 / r^2, whatever its size") {
  const double intensity = 300, distance = 3;
  for (const double area : {0.004, 0.0005}) {
    const Source source =
        as_small_source({intensity / area, area / (distance * distance), 1.5}, area);
    CHECK(ugr(std::span(&source, 1), 20) ==
          Approx(8 * std::log10(0.25 / 20 * 200 * intensity * intensity /
                                (distance * distance * 1.5 * 1.5))));
  }
  const Source large{1000, 0.1, 1};
  CHECK(as_small_source(large, 0.005).luminance == 1000);
}

TEST_CASE("a luminous ceiling has Einhorn's form of the rating") {
  // With CC = 1: 8 log10 (2 (1 + E_d / 220) / (E_i + E_d) sum), as 2.55 pi / 4 is 2.003.
  const double direct = 800, indirect = 250, sum = 3000;
  const Source source{std::sqrt(sum / 0.5), 0.5, 1};
  const double plain = ugr(std::span(&source, 1), indirect / glm::pi<double>());
  CHECK(ggr(plain, direct, indirect, 1) ==
        Approx(8 * std::log10(2.55 * glm::pi<double>() / 4 * (1 + direct / 220) /
                              (indirect + direct) * sum)));
  CHECK(ggr(plain, direct, indirect, 0.15) ==
        Approx(plain - 0.02 * 8 * std::log10(2.55 * (1 + direct / 220) / (1 + direct / indirect))));
  CHECK(ggr(plain, direct, indirect, 0.01) == ggr(plain, direct, indirect, 0.15));
}

TEST_CASE("DGP adds the light at the eye and contrasts, and is at most 1") {
  CHECK(dgp({}, 2000) == Approx(5.87e-5 * 2000 + 0.16));
  const Source window{8000, 0.4, 1.2};
  const double contrast = 8000.0 * 8000 * 0.4 / (std::pow(2000, 1.87) * 1.44);
  CHECK(dgp(std::span(&window, 1), 2000) ==
        Approx(5.87e-5 * 2000 + 0.0918 * std::log10(1 + contrast) + 0.16));
  CHECK(dgp({}, 1e5) == 1);
  CHECK(dgp({}, 0) == Approx(0.16));
}

TEST_CASE("the low-light correction is a half at 166.7 lux, and nothing from 1000 lux on") {
  CHECK(low_light_correction(4 / 0.024) == Approx(0.5));
  CHECK(low_light_correction(0) == Approx(1 / (1 + std::exp(4.0))));
  CHECK(low_light_correction(1000) == 1);
  CHECK(low_light_correction(999.9) == Approx(1).epsilon(1e-6));
}

TEST_CASE("DGI of one source is Hopkinson's") {
  const Source window{5000, 0.3, 1.5};
  const double weighed = 0.3 / 2.25;
  CHECK(dgi(std::span(&window, 1), 100) ==
        Approx(10 * std::log10(0.478 * std::pow(5000, 1.6) * std::pow(weighed, 0.8) /
                               (100 + 0.07 * std::sqrt(0.3) * 5000))));
}

// Sources in pictures whose light is known in closed form.

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

// Eyes and their directions.

TEST_CASE("a grid has its directions along the axes of the plan, clockwise from ahead") {
  measuring::SensorGrid grid{"point", {{{1, 1.2, 2}, {0, 1, 0}}, {{2, 1.2, 2}, {0, 1, 0}}}, {}};
  const auto all = observers_on(grid, trace::PlanAxes(), 4);
  REQUIRE(all.size() == 8);
  CHECK(all[0].name == "point 1, 0 degrees");
  CHECK(all[7].name == "point 2, 270 degrees");
  const glm::dvec3 directions[]{{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(glm::distance(all[i].forward, directions[i]) < 1e-12);
    CHECK(glm::distance(all[i].up, glm::dvec3(0, 1, 0)) < 1e-12);
  }
  CHECK(all[4].position.x == 2);
}

TEST_CASE("eyes that look up or down have an up of their own, at a right angle") {
  for (const glm::dvec3& towards :
       {glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 1, -1)}) {
    const Observer observer = Observer::looking("eye", {0, 0, 0}, 3.0 * towards, {0, 1, 0});
    CHECK(glm::length(observer.forward) == Approx(1));
    CHECK(glm::length(observer.up) == Approx(1));
    CHECK(glm::dot(observer.forward, observer.up) == Approx(0).margin(1e-12));
  }
}

}  // namespace
}  // namespace photile::test
