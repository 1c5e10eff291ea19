// The formulas of glare against numbers worked out by hand and published values.
#include "glare/ratings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace photile::test {
namespace {

using namespace photile::glare;

const Observer ahead{"eye", glm::dvec3(0), {0, 1, 0}, {0, 0, 1}};

/// The position index of a luminaire R ahead, T aside and H above.
double index_at(double t_over_r, double h_over_r) {
  return position_index(ahead, glm::normalize(glm::dvec3(t_over_r, 1, h_over_r)));
}

}  // namespace

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

}  // namespace photile::test
