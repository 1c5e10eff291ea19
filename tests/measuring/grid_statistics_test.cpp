// Figures of a grid and their errors, against values that are known, and against their own spread.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "measuring/measurement.hpp"

namespace photile::test {

using namespace photile::measuring;

namespace {

using Repeats = std::vector<std::vector<float>>;

/// Values 100 + index with normal noise.
Repeats noisy(std::mt19937& random, std::size_t repeats, std::size_t sensors, double slope,
              double noise) {
  std::normal_distribution<double> normal(0, noise);
  Repeats values(repeats);
  for (auto& repeat : values) {
    for (std::size_t i = 0; i < sensors; ++i) {
      repeat.push_back(static_cast<float>(100 + slope * static_cast<double>(i) + normal(random)));
    }
  }
  return values;
}

}  // namespace

TEST_CASE("without noise the figures are those of the values, and their errors 0") {
  const Repeats repeats(3, {200, 500, 300, 400});
  const GridStatistics s = statistics_of(repeats, 0, 4);
  CHECK(s.mean.value == 350);
  CHECK(s.minimum.value == 200);
  CHECK(s.maximum.value == 500);
  CHECK(s.uniformity.value == Approx(200.0 / 350));
  CHECK(s.diversity.value == Approx(0.4));
  CHECK(s.minimum_at_most == 200);
  CHECK(s.maximum_at_least == 500);
  for (const Measured& each : {s.mean, s.minimum, s.maximum, s.uniformity, s.diversity}) {
    CHECK(each.standard_error == Approx(0).margin(1e-12));
  }
}

TEST_CASE("only the sensors of the grid count") {
  const Repeats repeats(2, {1, 200, 300, 9000});
  const GridStatistics s = statistics_of(repeats, 1, 2);
  CHECK(s.minimum.value == 200);
  CHECK(s.maximum.value == 300);
}

TEST_CASE("the standard error of a sensor is that of the mean of its repeats") {
  const std::vector<Measured> means = means_of(Repeats{{1, 10}, {3, 10}, {5, 10}});
  CHECK(means[0].value == Approx(3));
  CHECK(means[0].standard_error == Approx(2 / std::sqrt(3.0)));
  CHECK(means[1].standard_error == 0);
}

TEST_CASE("a dark grid has no uniformity, and no NaN") {
  const GridStatistics s = statistics_of(Repeats(2, {0, 0}), 0, 2);
  CHECK(s.uniformity.value == 0);
  CHECK(s.diversity.value == 0);
  CHECK(s.uniformity.standard_error == 0);
}

TEST_CASE("standard errors are the spread that repeated measurements have") {
  std::mt19937 random(7);
  double squares_mean = 0, squares_minimum = 0, told_mean = 0, told_minimum = 0;
  constexpr int measurements = 2000;
  for (int i = 0; i < measurements; ++i) {
    const GridStatistics s = statistics_of(noisy(random, 8, 10, 5, 2), 0, 10);
    squares_mean += std::pow(s.mean.value - 122.5, 2);
    squares_minimum += std::pow(s.minimum.value - 100, 2);
    told_mean += std::pow(s.mean.standard_error, 2);
    told_minimum += std::pow(s.minimum.standard_error, 2);
  }
  // Sensors 5 lux apart with a noise of 0.7: the darkest is always the same one. A standard
  // deviation from 2000 samples has an error of 1.6%, that of variances twice as much.
  CHECK(told_mean / squares_mean == Approx(1).epsilon(0.15));
  CHECK(told_minimum / squares_minimum == Approx(1).epsilon(0.15));
}

TEST_CASE("the error of a minimum that noise chooses is that of the sensor it chooses") {
  // 100 sensors all have 100 lux, or the first half has an eighth of the noise.
  const bool alike = GENERATE(true, false);
  const std::size_t repeats = GENERATE(8, 32);
  CAPTURE(alike, repeats);
  constexpr std::size_t sensors = 100;
  constexpr double noise = 5;
  std::mt19937 random(7);
  double spread = 0, mean_minimum = 0, told = 0, of_darkest = 0;
  constexpr int measurements = 2000;
  for (int i = 0; i < measurements; ++i) {
    Repeats values = noisy(random, repeats, sensors, 0, noise);
    const double scale = alike ? 1 : 0.125;
    for (auto& repeat : values) {
      for (std::size_t s = 0; s < sensors / 2; ++s) {
        repeat[s] = static_cast<float>(100 + scale * (static_cast<double>(repeat[s]) - 100));
      }
    }
    const std::vector<Measured> means = means_of(values);
    const auto darkest =
        std::min_element(means.begin(), means.end(),
                         [](const Measured& a, const Measured& b) { return a.value < b.value; });
    const bool quiet = darkest - means.begin() < static_cast<std::ptrdiff_t>(sensors / 2);
    of_darkest += std::pow((quiet ? scale : 1) * noise, 2) / static_cast<double>(repeats);
    const GridStatistics s = statistics_of(values, 0, sensors);
    told += std::pow(s.minimum.standard_error, 2);
    mean_minimum += s.minimum.value;
    spread += std::pow(s.minimum.value, 2);
  }
  mean_minimum /= measurements;
  spread = spread / measurements - mean_minimum * mean_minimum;
  // A variance from 8 values has a deviation of 53%, and the mean of 2000 of them one of 1.2%.
  CHECK(told / of_darkest == Approx(1).epsilon(0.06));
  CHECK(told / measurements > spread);
}

TEST_CASE("the true minimum and maximum lie between what noise pulls down and up") {
  std::mt19937 random(7);
  double low = 0, high = 0, top_low = 0, top_high = 0;
  constexpr int measurements = 500;
  for (int i = 0; i < measurements; ++i) {
    const GridStatistics s = statistics_of(noisy(random, 8, 100, 0, 5), 0, 100);  // all 100 lux
    low += s.minimum.value / measurements;
    high += s.minimum_at_most / measurements;
    top_low += s.maximum_at_least / measurements;
    top_high += s.maximum.value / measurements;
  }
  // The least of 100 normal values is 2.5 deviations low (tables of order statistics).
  CHECK(low == Approx(100 - 2.508 * 5 / std::sqrt(8.0)).epsilon(0.002));
  CHECK(top_high == Approx(100 + 2.508 * 5 / std::sqrt(8.0)).epsilon(0.002));
  // What the left-out repeat says of the chosen sensor is not biased at all here.
  CHECK(high == Approx(100).epsilon(0.002));
  CHECK(top_low == Approx(100).epsilon(0.002));
}

}  // namespace photile::test
