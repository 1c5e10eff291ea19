// The filter over linked points, on values whose truth is known.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include "cache/irradiance_filter.hpp"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <thread>

#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"

namespace photile::test {
namespace {

constexpr int side = 48, batches = 8, border = 8;

std::size_t index(int x, int y) { return static_cast<std::size_t>(y * side + x); }

/// A square lattice, each point linked to its four neighbours.
cache::PointLinks lattice() {
  cache::PointLinks links;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (x > 0) links.items.push_back(static_cast<std::uint32_t>(index(x - 1, y)));
      if (x + 1 < side) links.items.push_back(static_cast<std::uint32_t>(index(x + 1, y)));
      if (y > 0) links.items.push_back(static_cast<std::uint32_t>(index(x, y - 1)));
      if (y + 1 < side) links.items.push_back(static_cast<std::uint32_t>(index(x, y + 1)));
      links.first.push_back(static_cast<std::uint32_t>(links.items.size()));
      links.position.emplace_back(x, y, 0);
    }
  return links;
}

/// About normal, mean 0, standard deviation 1.
double noise(std::uint64_t seed, std::uint64_t number) {
  double sum = -6;
  for (std::uint32_t block = 0; block < 3; ++block) {
    const auto random = trace::RandomStream(seed, number, 0).block(trace::Purpose::emission, block);
    for (int word = 0; word < 4; ++word) sum += double{random.uniform(word)};
  }
  return sum;
}

using Truth = std::function<double(int x, int y)>;

/// Grey light of `lights` layers, each the truth with noise of its own in every batch.
///   error   standard error of each layer
LightTable noisy(const Truth& truth, double error, std::uint64_t seed, int lights = 1) {
  LightTable result(static_cast<std::size_t>(lights), false);
  result.batches = batches;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int light = 0; light < lights; ++light) {
        double sum = 0;
        for (int b = 0; b < batches; ++b) {
          const std::uint64_t number = (index(x, y) * 8 + static_cast<std::uint64_t>(light)) * 64 +
                                       static_cast<std::uint64_t>(b);
          const double value =
              truth(x, y) + std::sqrt(double{batches}) * error * noise(seed, number);
          result.batch.push_back(static_cast<float>(value));
          sum += value;
        }
        result.irradiance.emplace_back(static_cast<float>(sum / batches));
      }
  return result;
}

/// Over the columns [from, to), but for the border.
double rms_error(const LightTable& light, const Truth& truth, int from, int to) {
  double sum = 0;
  int count = 0;
  for (int y = border; y < side - border; ++y)
    for (int x = from; x < to; ++x, ++count) {
      const double difference = double{light.irradiance[index(x, y)].g} - truth(x, y);
      sum += difference * difference;
    }
  return std::sqrt(sum / count);
}

const std::vector<double> one_light{1.0};

}  // namespace

TEST_CASE("filter: noise on an even surface falls, and its error is known afterwards") {
  const Truth even = [](int, int) { return 1.0; };
  constexpr int inner = side - 2 * border;
  double known = 0, found = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const LightTable after =
        cache::filter_irradiance(noisy(even, 0.05, seed), lattice(), one_light);
    found += std::pow(rms_error(after, even, border, side - border), 2) / 8;
    for (int y = border; y < side - border; ++y)
      for (int x = border; x < side - border; ++x) {
        known += std::pow(after.total(index(x, y), one_light).error, 2) / (8.0 * inner * inner);
      }
  }
  CHECK(std::sqrt(found) < 0.05 / 3);
  CHECK(std::sqrt(known / found) == Approx(1).margin(0.2));
}

TEST_CASE("filter: steps that exceed the noise stay, slopes stay what they are") {
  const double height = GENERATE(0.5, 1.0);  // 7 and 14 standard errors of a difference
  const Truth step = [&](int x, int) { return x < side / 2 ? 1.0 : 1.0 + height; };
  const LightTable after = cache::filter_irradiance(noisy(step, 0.05, 3), lattice(), one_light);
  double left = 0, right = 0;  // beside the step
  for (int y = border; y < side - border; ++y) {
    left += double{after.irradiance[index(side / 2 - 1, y)].g} / (side - 2 * border);
    right += double{after.irradiance[index(side / 2, y)].g} / (side - 2 * border);
  }
  CHECK(right - left == Approx(height).epsilon(0.1));
  const Truth slope = [](int x, int) { return 1.0 + 0.02 * x; };
  CHECK(rms_error(cache::filter_irradiance(noisy(slope, 0.05, 4), lattice(), one_light), slope, 12,
                  side - 12) < 0.05 / 2.5);
}

TEST_CASE("filter: slopes go on to where surface ends") {
  // One lamp rises by 6% from point to point, another falls as much: their sum is even.
  const Truth rising = [](int x, int) { return 1.0 + 0.06 * x; };
  const Truth falling = [](int x, int) { return 4.0 - 0.06 * x; };
  const std::vector<double> powers{1.0, 1.0};
  cache::PointLinks no_sides = lattice();  // points on one spot lie to no side of each other
  no_sides.position.assign(no_sides.position.size(), glm::vec3(0.0f));
  double with_sides = 0, without = 0, squares = 0, squares_without = 0;
  constexpr int seeds = 8, rows = side - 2 * border;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    LightTable both = noisy(rising, 0.05, 2 * seed, 2);
    const LightTable other = noisy(falling, 0.05, 2 * seed + 1, 2);
    for (std::size_t i = 1; i < both.irradiance.size(); i += 2) {
      both.irradiance[i] = other.irradiance[i];
      std::copy_n(other.batch.begin() + static_cast<std::ptrdiff_t>(i * batches), batches,
                  both.batch.begin() + static_cast<std::ptrdiff_t>(i * batches));
    }
    const auto at_end = [&](const cache::PointLinks& links, double& sum_of_squares) {
      const LightTable after = cache::filter_irradiance(both, links, powers);
      double sum = 0;
      for (int y = border; y < side - border; ++y) {
        const double off = double{after.irradiance[2 * index(0, y)].g} - rising(0, y);
        sum += off / (rows * seeds);
        sum_of_squares += off * off / (rows * seeds);
      }
      return sum;
    };
    with_sides += at_end(lattice(), squares);
    without += at_end(no_sides, squares_without);
  }
  CAPTURE(with_sides, without, squares, squares_without);
  CHECK(without > 0.03);
  CHECK(std::abs(with_sides) < without / 3);
  CHECK(std::sqrt(squares) < 0.05 / 2);
  CHECK(squares < squares_without);
}

TEST_CASE("filter: without noise nothing changes, and what is dark stays dark") {
  const Truth waves = [](int x, int y) { return 2 + std::sin(x * 0.7) * std::cos(y * 0.9); };
  const LightTable before = noisy(waves, 0, 1);
  const LightTable after = cache::filter_irradiance(before, lattice(), one_light);
  for (std::size_t i = 0; i < before.irradiance.size(); ++i) {
    REQUIRE(after.irradiance[i].g == Approx(before.irradiance[i].g).epsilon(1e-6));
  }
  const Truth black = [](int, int) { return 0.0; };
  for (const glm::vec3& value :
       cache::filter_irradiance(noisy(black, 0, 1), lattice(), one_light).irradiance) {
    REQUIRE(value == glm::vec3(0.0f));
  }
}

TEST_CASE("filter: light that few rays find is spread over the points that found none of it") {
  // The light of a sky through a small window: a batch finds it in one of ten times, so that two
  // points of five found nothing, and do not know that they err.
  constexpr double found = 0.1;
  const Truth even = [](int, int) { return 1.0; };
  LightTable rare = noisy(even, 0, 1);
  for (std::size_t point = 0; point < rare.irradiance.size(); ++point) {
    double sum = 0;
    for (std::size_t b = 0; b < batches; ++b) {
      const auto random = trace::RandomStream(5, point, b).block(trace::Purpose::emission, 0);
      const double value = random.uniform_double(0) < found ? 1 / found : 0;
      rare.batch[point * batches + b] = static_cast<float>(value);
      sum += value;
    }
    rare.irradiance[point] = glm::vec3(static_cast<float>(sum / batches));
  }
  const double before = rms_error(rare, even, border, side - border);
  const cache::NoiseTolerance of_looks{.errors = 3, .ratio = 2};
  const LightTable after =
      cache::filter_irradiance(rare, lattice(), one_light, {.rounds = 8, .tolerated = of_looks});
  double mean = 0, of_found = 0;
  for (std::size_t point = 0; point < after.irradiance.size(); ++point) {
    mean += double{after.irradiance[point].g};
    of_found += double{rare.irradiance[point].g};
  }
  CAPTURE(before, mean / of_found);
  CHECK(mean / of_found == Approx(1).margin(0.05));
  CHECK(rms_error(after, even, border, side - border) < 0.35 * before);
}

TEST_CASE("filter: noise of a lamp falls beside the border of the sun as it does without the sun") {
  const Truth step = [](int x, int) { return x < side / 2 ? 1.0 : 90.0; };
  const Truth even = [](int, int) { return 2.0; };
  const LightTable sun = noisy(step, 0.5, 5), lamp = noisy(even, 0.1, 6);
  LightTable both;
  both.batches = batches;
  for (std::size_t i = 0; i < std::size_t{side * side}; ++i) {
    for (const LightTable* one : {&sun, &lamp}) both.append(one->slice(i, 1));
  }
  both.lights = 2;
  const LightTable layers = cache::filter_irradiance(both, lattice(), std::vector<double>{1, 1});
  LightTable of_sun, of_lamp;
  for (std::size_t i = 0; i < std::size_t{side * side}; ++i) {
    of_sun.irradiance.push_back(layers.irradiance[2 * i]);
    of_lamp.irradiance.push_back(layers.irradiance[2 * i + 1]);
  }
  const auto beside_border = [](const LightTable& light, const Truth& truth) {
    return rms_error(light, truth, side / 2 - 2, side / 2 + 2);
  };
  const double alone = beside_border(cache::filter_irradiance(lamp, lattice(), one_light), even);
  CHECK(alone < 0.5 * beside_border(lamp, even));
  CHECK(beside_border(of_lamp, even) < 1.1 * alone);
  CHECK(beside_border(of_sun, step) < 0.5);  // and the border stays
}

TEST_CASE("filter: sparse layers are filtered as dense ones, on any number of threads") {
  const Truth step = [](int x, int) { return x < side / 2 ? 1.0 : 1.6; };
  const LightTable dense = noisy(step, 0.05, 6, 2);
  LightTable sparse = dense;
  sparse.first.push_back(0);
  for (std::size_t i = 0; i < std::size_t{side * side}; ++i) {
    sparse.light.push_back(0);
    sparse.light.push_back(1);
    sparse.first.push_back(2 * (i + 1));
  }
  const std::vector<double> powers{1, 1};
  const LightTable expected = cache::filter_irradiance(dense, lattice(), powers);
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const LightTable after = cache::filter_irradiance(sparse, lattice(), powers);
    CHECK(after.irradiance == expected.irradiance);
    CHECK(after.batch == expected.batch);
    CHECK(after.first == sparse.first);
  }
}

TEST_CASE("filter: the same bits whether the calling thread flushes denormal numbers or not") {
  // Libraries that a host program loads may have set either. Beside a border a point of no light
  // gets some 1e-40 of what is beyond.
  const auto lit_half = [] {
    LightTable light = noisy([](int, int) { return 1.0; }, 0.05, 5);
    for (std::size_t i = 0; i < light.irradiance.size(); ++i) {
      const float scale = i % side < side / 2 ? 0.0f : 1e-12f;
      light.irradiance[i] *= scale;
      for (int b = 0; b < batches; ++b)
        light.batch[i * batches + static_cast<std::size_t>(b)] *= scale;
    }
    return light;
  };
  const std::vector<double> powers{1.0};
  const auto filtered = [&] {
    return filter_irradiance(lit_half(), lattice(), powers, {.rounds = 2});
  };
  const LightTable as_it_is = filtered();
  LightTable flushed;
  std::thread flushing([&] {  // TBB goes by what a thread does when it first shares work
    const trace::FlushDenormals flush_denormals;
    flushed = filtered();
  });
  flushing.join();
  CHECK(as_it_is.irradiance == flushed.irradiance);
  CHECK(as_it_is.batch == flushed.batch);
}

}  // namespace photile::test
