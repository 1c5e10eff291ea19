// Numbers of neighbours of their own for each hit.
#include "estimate/neighbour_choice.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "statistical_tests.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

const std::vector<int> levels{50, 200, 800};

/// Densities by the k-th of points of a Poisson process of density 1: r_k^2 pi is the sum of k
/// exponential gaps, and the photons of a smaller k are among those of a larger one.
std::vector<double> uniform_densities(std::mt19937& random) {
  std::exponential_distribution<double> gap;
  std::vector<double> values;
  double area = 0;
  int k = 0;
  for (const int level : levels) {
    for (; k < level; ++k) area += gap(random);
    values.push_back((level - 1) / area);
  }
  return values;
}

}  // namespace

TEST_CASE("levels are quarters of the largest, down to the least") {
  CHECK(estimate::neighbour_levels(50, 800) == std::vector{50, 200, 800});
  CHECK(estimate::neighbour_levels(51, 800) == std::vector{200, 800});
  CHECK(estimate::neighbour_levels(800, 800) == std::vector{800});
  CHECK(estimate::neighbour_levels(1, 5) == std::vector{1, 5});
}

TEST_CASE("estimates that agree take the most neighbours, a biased one the level before it") {
  CHECK(estimate::least_error_level(std::vector{1.0, 1.05, 0.98}, levels) == 2);
  CHECK(estimate::least_error_level(std::vector{1.0, 1.05, 0.5}, levels) == 1);  // blurred to half
  CHECK(estimate::least_error_level(std::vector{1.0, 2.5, 2.5}, levels) ==
        0);  // light from beyond a border
  CHECK(estimate::least_error_level(std::vector{0.0, 0.0, 0.0}, levels) == 2);
  CHECK(estimate::least_error_level(std::vector{0.0, 0.0, 0.1}, levels) == 1);
  CHECK(estimate::least_error_level(std::vector{1.0, 0.0, 0.0}, levels) == 0);
}

TEST_CASE("where light is uniform nearly all hits take the most neighbours, and stay unbiased") {
  std::mt19937 random(5);
  std::vector<double> means;
  int most = 0;
  constexpr int seeds = 16, hits = 4000;
  for (int seed = 0; seed < seeds; ++seed) {
    double sum = 0;
    for (int hit = 0; hit < hits; ++hit) {
      const std::vector<double> values = uniform_densities(random);
      const std::size_t level = estimate::least_error_level(values, levels);
      most += level + 1 == levels.size();
      sum += values[level];
    }
    means.push_back(sum / hits);
  }
  CHECK(most > 0.97 * seeds * hits);
  const auto verdict = test::mean_is(means, 1.0, 0.005);
  INFO(verdict.message);
  CHECK(verdict.passed);
}

TEST_CASE("hits take all lights' estimates from one level") {
  // Two hits, two lights. The first hit agrees, the second changes at the last level.
  const auto grey = [](float value) { return glm::vec3(value); };
  std::vector<LightTable> by_level(2);
  by_level[0].irradiance = {grey(1), grey(2), grey(4), grey(8)};
  by_level[1].irradiance = {grey(1.01f), grey(2.02f), grey(1), grey(2)};
  const std::vector<int> neighbours{50, 200};
  const LightTable chosen =
      estimate::estimates_of_least_error(by_level, neighbours, std::vector{1.0, 1.0});
  CHECK(chosen.irradiance == std::vector{grey(1.01f), grey(2.02f), grey(4), grey(8)});

  // The levels with lists of the lights that reach a hit, of different lengths.
  by_level[0].first = {0, 2, 4};
  by_level[0].light = {0, 1, 0, 1};
  by_level[1].irradiance = {grey(3.03f), grey(1), grey(2)};
  by_level[1].first = {0, 1, 3};
  by_level[1].light = {1, 1, 0};
  const LightTable sparse =
      estimate::estimates_of_least_error(by_level, neighbours, std::vector{1.0, 1.0});
  CHECK(sparse.first == std::vector<std::uint64_t>{0, 1, 3});
  CHECK(sparse.light == std::vector<std::uint16_t>{1, 0, 1});
  CHECK(sparse.irradiance == std::vector{grey(3.03f), grey(4), grey(8)});
}

TEST_CASE("a light that is off has no say in the choice") {
  std::vector<LightTable> by_level(2);
  by_level[0].irradiance = {glm::vec3(1), glm::vec3(1)};
  by_level[1].irradiance = {glm::vec3(1), glm::vec3(9)};  // only the second light changes
  const std::vector<int> neighbours{50, 200};
  const auto second = [&](double power) {
    return estimate::estimates_of_least_error(by_level, neighbours, std::vector{1.0, power})
        .irradiance[1];
  };
  CHECK(second(0.0) == glm::vec3(9));
  CHECK(second(1.0) == glm::vec3(1));
}

TEST_CASE("with as few neighbours as most a picture is that of a fixed number, bit for bit") {
  const Scene scene = test::furnished_room();
  RenderParameters parameters;
  parameters.photons.emitted_photons = 20'000;
  parameters.film.width = parameters.film.height = 24;
  const auto picture = [&] {
    return render(scene, test::room_camera(), test::device(), parameters).layers;
  };
  const LightLayers fixed = picture();
  parameters.least_neighbours = parameters.neighbours;
  CHECK(test::same_bits(picture(), fixed));
  parameters.least_neighbours = 5;
  CHECK_FALSE(test::same_bits(picture(), fixed));
}

}  // namespace photile::test
