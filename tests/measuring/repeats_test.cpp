// Repeats of a measurement: each has random numbers of its own, in this run and in all others.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "measuring/measurement.hpp"
#include "photile/layered_picture.hpp"
#include "test_scenes.hpp"

namespace photile::test {

using namespace photile::measuring;

namespace {

/// One sensor of a furnished room, by few rays.
Readings measured(const Scene& scene, std::uint64_t seed, int repeats) {
  const std::vector<SensorGrid> grids{{"point", {{{1.0, 1.0, 0.75}, {0, 0, 1}}}, {}}};
  MeasuringParameters parameters;
  parameters.by_paths = true;
  parameters.gathering.rays = 64;
  parameters.repeats = repeats;
  parameters.photons.seed = seed;
  return measure_grids(scene, grids, LightMix::of(scene, 683), {}, parameters, Progress::none());
}

}  // namespace

TEST_CASE("runs with neighbouring seeds share no repeat") {
  const Scene scene = test::furnished_room();
  std::set<float> values;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Readings readings = measured(scene, seed, 5);
    for (std::size_t repeat = 0; repeat < readings.repeats(); ++repeat) {
      values.insert(readings.total(repeat)[0]);
    }
  }
  CHECK(values.size() == 50);
}

TEST_CASE("readings of neighbouring seeds differ as their standard errors say") {
  const Scene scene = test::furnished_room();
  constexpr int pairs = 200, repeats = 8;
  double squares = 0;
  const auto mean_of = [&](std::uint64_t seed) {
    const Readings readings = measured(scene, seed, repeats);
    std::vector<std::vector<float>> values;
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      values.push_back(readings.total(repeat));
    }
    return means_of(values)[0];
  };
  for (std::uint64_t pair = 0; pair < pairs; ++pair) {
    const Measured a = mean_of(2 * pair), b = mean_of(2 * pair + 1);
    squares += std::pow(a.value - b.value, 2) /
               (std::pow(a.standard_error, 2) + std::pow(b.standard_error, 2)) / pairs;
  }
  // The square of a Student t of 14 degrees of freedom has the mean 14 / 12, and the mean of 200 a
  // deviation of 0.13. Pairs that share seven of eight repeats would have an eighth of it.
  CHECK(squares == Approx(14.0 / 12).margin(5 * 0.13));
}

}  // namespace photile::test
