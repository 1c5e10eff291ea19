// The tabular method against published factors and a sum of its own.
#include "glare/ugr_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "glare/ratings.hpp"

namespace photile::test {
namespace {

using namespace photile::glare;

/// A disc of `diameter` metres with Lambert's distribution below, `lumens` together.
IntensityDistribution lambertian(double lumens, double diameter) {
  std::vector<double> polar;
  std::vector<float> candela;
  for (int i = 0; i <= 90; ++i) polar.push_back(i);
  for (int plane = 0; plane < 2; ++plane) {
    for (int i = 0; i <= 90; ++i) {
      candela.push_back(
          static_cast<float>(lumens / glm::pi<double>() * std::cos(i * glm::pi<double>() / 180)));
    }
  }
  IntensityDistribution distribution("disc", {}, polar, {0, 360}, candela);
  distribution.set_opening(
      {.x = diameter, .y = diameter, .shape = LuminousOpening::Shape::upright_cylinder});
  return distribution;
}

}  // namespace

TEST_CASE("transfer factors are those of CIE 190, table 5, for 4H x 8H") {
  const double published[5][3]{{0.115, 0.211, 0.307},
                               {0.106, 0.117, 0.283},
                               {0.100, 0.187, 0.211},
                               {0.093, 0.104, 0.196},
                               {0.081, 0.092, 0.114}};
  for (std::size_t i = 0; i < table_reflectances.size(); ++i) {
    for (const TableRoom& room : {TableRoom{4, 8}, TableRoom{8, 4}}) {
      const TransferFactors factors = transfer_factors(room, table_reflectances[i]);
      CHECK(factors.floor == Approx(published[i][0]).margin(6e-4));
      CHECK(factors.walls == Approx(published[i][1]).margin(6e-4));
      CHECK(factors.ceiling == Approx(published[i][2]).margin(6e-4));
    }
  }
}

TEST_CASE("a disc has the ratings of a sum over its array") {
  constexpr double lumens = 2000, diameter = 0.3, h = 2;
  const UgrTable table = ugr_table(lambertian(lumens, diameter), 1);
  // A lambertian source is as bright from everywhere.
  const double area = glm::pi<double>() / 4 * diameter * diameter,
               luminance = lumens / (glm::pi<double>() * area);
  const Observer eye{"", glm::dvec3(0), {0, 1, 0}, {0, 0, 1}};
  double sum = 0;
  for (double x = -7 * h / 2; x < 4 * h; x += h) {  // 8H across
    for (double y = h / 2; y < 4 * h; y += h) {     // 4H along
      const double r2 = x * x + y * y + h * h;
      if (std::abs(x) > 3 * y) continue;
      const double p = position_index(eye, glm::dvec3(x, y, h) / std::sqrt(r2));
      sum += luminance * luminance * area * h / (r2 * std::sqrt(r2)) / (p * p);
    }
  }
  // The floor below a Lambertian array that fills the ceiling gets nearly the form factor: k =
  // 2.67.
  const TransferFactors factors = transfer_factors({8, 4}, {0.7, 0.5, 0.2});
  const double a = 8, b = 4;
  const double facing = 2 / (glm::pi<double>() * a * b) *
                        (0.5 * std::log((1 + a * a) * (1 + b * b) / (1 + a * a + b * b)) +
                         a * std::sqrt(1 + b * b) * std::atan(a / std::sqrt(1 + b * b)) +
                         b * std::sqrt(1 + a * a) * std::atan(b / std::sqrt(1 + a * a)) -
                         a * std::atan(a) - b * std::atan(b));
  const double wall_area = 2 * h * (8 + 4) * h;
  const double indirect =
      lumens * 32 / wall_area * (facing * factors.floor + (1 - facing) * factors.walls);
  const double expected = 8 * std::log10(0.25 * glm::pi<double>() / indirect * sum);
  const std::size_t room = 12;
  REQUIRE(table_rooms[room].across == 8);
  REQUIRE(table_rooms[room].along == 4);
  CHECK(table.crosswise[room][0] == Approx(expected).margin(0.05));
  CHECK(table.endwise[room][0] == Approx(expected).margin(0.05));
}

TEST_CASE("twice the flux is 8 log10 2 worse, twice the area 8 log10 2 better") {
  const UgrTable once = ugr_table(lambertian(1000, 0.3));
  const UgrTable twice = ugr_table(lambertian(2000, 0.3));
  const UgrTable wide = ugr_table(lambertian(1000, 0.3 * std::sqrt(2)));
  for (std::size_t room = 0; room < table_rooms.size(); ++room) {
    for (std::size_t i = 0; i < table_reflectances.size(); ++i) {
      CHECK(twice.crosswise[room][i] - once.crosswise[room][i] ==
            Approx(8 * std::log10(2)).margin(1e-4));
      CHECK(once.endwise[room][i] - wide.endwise[room][i] ==
            Approx(8 * std::log10(2)).margin(1e-4));
    }
  }
}

TEST_CASE("a long lamp that shines to its sides alone glares crosswise, not endwise") {
  std::vector<double> polar{0, 60, 90}, azimuth{0, 90, 180, 270, 360};
  std::vector<float> candela;
  for (const double a : azimuth) {
    for (const double g : polar)
      candela.push_back(a == 0 || a >= 179 ? (g == 0 ? 300.f : 200.f) : 20.f);
  }
  candela[9] = candela[10] = candela[11] = 20.f;  // 270
  const auto of_length = [&](bool along_zero) {
    IntensityDistribution lamp("lamp", {}, polar, azimuth, candela);
    lamp.set_opening({.x = along_zero ? 1.2 : 0.1, .y = along_zero ? 0.1 : 1.2});
    return ugr_table(lamp);
  };
  // C0 is across the length, as in EULUMDAT: seen crosswise it is bright.
  const UgrTable across = of_length(false);
  CHECK(across.crosswise[10][0] > across.endwise[10][0] + 3);
  // Light along the length, as an LM-63 file may have it, is bright endwise.
  const UgrTable along = of_length(true);
  CHECK(along.endwise[10][0] > along.crosswise[10][0] + 3);
}

TEST_CASE("luminaires seen beyond 85 degrees from below do not count") {
  const std::vector<float> candela{0, 0, 1000, 1000, 0, 0, 1000, 1000};
  IntensityDistribution lamp("lamp", {}, {0, 85, 85.05, 90}, {0, 360}, candela);
  lamp.set_opening({.x = 0.3, .y = 0.3, .shape = LuminousOpening::Shape::upright_cylinder});
  const UgrTable table = ugr_table(lamp);
  for (const auto* rows : {&table.crosswise, &table.endwise}) {
    for (const UgrTable::Row& row : *rows) CHECK(std::isnan(row[0]));
  }
}

TEST_CASE("without an opening nothing is rated") {
  IntensityDistribution lamp("lamp", {}, {0, 90}, {0, 360}, {100, 100, 100, 100});
  CHECK(std::isnan(ugr_table(lamp).crosswise[0][0]));
}

}  // namespace photile::test
