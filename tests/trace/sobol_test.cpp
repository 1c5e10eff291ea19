// Scrambled Sobol points: nets, uniformity, known integrals, errors.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "statistical_tests.hpp"
#include "trace/direct_light.hpp"
#include "trace/random_stream.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

RandomBlock scramble(std::uint64_t number, std::uint32_t pair = 0) {
  return RandomStream(2011, number, 0).block(Purpose::film_position, pair);
}

/// Second dimension of Sobol's sequence by its direction numbers: v_1 = 1/2, v_(j+1) = v_j xor
/// v_j / 2 (Kollig and Keller, "Efficient multidimensional sampling", 2002).
std::uint32_t second_coordinate(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1) {
    if (index & 1) result ^= v;
  }
  return result;
}

double inside_quarter_disc(const glm::dvec2& p) { return glm::dot(p, p) < 1 ? 1 : 0; }
double smooth(const glm::dvec2& p) { return std::exp(p.x) * std::cos(p.y); }
const double quarter_disc = std::numbers::pi / 4;
const double smooth_integral = (std::numbers::e - 1) * std::sin(1.0);

template <class F>
double mean_of(const F& f, std::uint64_t scramble_number, std::uint32_t points) {
  const RandomBlock block = scramble(scramble_number);
  double sum = 0;
  for (std::uint32_t i = 0; i < points; ++i) sum += f(sobol_point(i, block));
  return sum / points;
}

/// Mean square error over many scrambles.
template <class F>
double squared_error(const F& f, double truth, std::uint32_t points) {
  constexpr int scrambles = 400;
  double sum = 0;
  for (int s = 0; s < scrambles; ++s) {
    const double difference = mean_of(f, static_cast<std::uint64_t>(s), points) - truth;
    sum += difference * difference;
  }
  return sum / scrambles;
}

}  // namespace

TEST_CASE("The second dimension is that of Sobol's direction numbers") {
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const std::uint32_t index = i < 50'000 ? i : i * 0x9E37'79B9u;
    REQUIRE(reversed_bits(second_sobol_digits(index)) == second_coordinate(index));
  }
}

TEST_CASE("Any aligned 2^n points have one in each elementary rectangle, whatever the scramble") {
  for (std::uint64_t number = 0; number < 50; ++number) {
    const RandomBlock block = scramble(number);
    for (int n = 0; n <= 8; ++n) {
      const std::uint32_t count = 1u << n;
      const std::uint32_t first = count * static_cast<std::uint32_t>(number * number);
      for (int columns = 0; columns <= n; ++columns) {
        std::set<std::pair<std::uint32_t, std::uint32_t>> met;
        for (std::uint32_t i = 0; i < count; ++i) {
          const glm::uvec2 p = sobol_words(first + i, block);
          met.emplace(columns == 0 ? 0 : p.x >> (32 - columns),
                      columns == n ? 0 : p.y >> (32 - (n - columns)));
        }
        REQUIRE(met.size() == count);
      }
    }
  }
}

TEST_CASE("Each point of the sequence is uniform over the square for random scrambles") {
  constexpr int trials = 65'536, cells = 16;
  for (const std::uint32_t index : {0u, 1u, 5u, 1000u, 0xFFFF'FFFFu}) {
    std::vector<double> counts(cells * cells, 0.0), fine(cells * cells, 0.0);
    for (std::uint64_t t = 0; t < trials; ++t) {
      const glm::uvec2 p = sobol_words(index, scramble(t));
      ++counts[(p.x >> 28) * cells + (p.y >> 28)];
      ++fine[((p.x >> 20) % cells) * cells + (p.y >> 20) % cells];
    }
    const std::vector<double> expected(cells * cells, trials / double{cells * cells});
    CHECK_VERDICT(counts_agree(counts, expected));
    CHECK_VERDICT(counts_agree(fine, expected));
  }
}

TEST_CASE("Digits after the first that differs are scrambled independently") {
  // Two numbers that share 3 digits: the scramble keeps those alike, tells the fourth apart, and
  // makes the next two of both anything.
  constexpr int trials = 65'536;
  std::vector<double> counts(16, 0.0);
  for (std::uint64_t t = 0; t < trials; ++t) {
    const std::uint32_t seed = scramble(t).word(1);
    const std::uint32_t a = scrambled_digits(0b0000'0101u, seed);
    const std::uint32_t b = scrambled_digits(0b0000'1101u, seed);
    REQUIRE(((a ^ b) & 0b1111u) == 0b1000u);
    ++counts[(a >> 4 & 3) * 4 + (b >> 4 & 3)];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(16, trials / 16.0)));
}

TEST_CASE("Pairs of dimensions with scrambles of their own know nothing of each other") {
  std::vector<double> counts(64, 0.0);
  constexpr std::uint32_t points = 64, trials = 2'000;
  for (std::uint64_t t = 0; t < trials; ++t)
    for (std::uint32_t i = 0; i < points; ++i) {
      const glm::uvec2 a = sobol_words(i, scramble(t, 0)), b = sobol_words(i, scramble(t, 1));
      ++counts[(a.x >> 29) * 8 + (b.x >> 29)];
    }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(64, points * trials / 64.0)));
}

TEST_CASE("Known integrals converge faster than at random") {
  // Sixteen times the points: at random 1/16 of the squared error; of smooth functions 1/16^3 but
  // for logarithms, over the inside of a curve 1/16^1.5 (Owen 1997).
  CHECK(squared_error(smooth, smooth_integral, 1024) <
        squared_error(smooth, smooth_integral, 64) / 1000);
  CHECK(squared_error(inside_quarter_disc, quarter_disc, 1024) <
        squared_error(inside_quarter_disc, quarter_disc, 64) / 35);
  // Sixteen points already: a disc's variance at random is q (1 - q) / n.
  CHECK(squared_error(inside_quarter_disc, quarter_disc, 16) <
        0.3 * quarter_disc * (1 - quarter_disc) / 16);
}

TEST_CASE("The scatter of independent scrambles is an honest error") {
  constexpr int trials = 2'000, batches = 8;
  double squares = 0, errors = 0;
  for (std::uint64_t t = 0; t < trials; ++t) {
    double sum = 0, sum_of_squares = 0;
    for (std::uint64_t b = 0; b < batches; ++b) {
      const double mean = mean_of(inside_quarter_disc, t * batches + b, 18);
      sum += mean;
      sum_of_squares += mean * mean;
    }
    const double mean = sum / batches;
    squares += (mean - quarter_disc) * (mean - quarter_disc);
    errors += (sum_of_squares / batches - mean * mean) / (batches - 1);
  }
  // Relative standard deviation of either: sqrt(2 / trials), and less.
  CHECK(squares / errors == Approx(1).margin(6 * std::sqrt(4.0 / trials)));
}

TEST_CASE("The looks of a pixel's samples share their sequences and take every lamp as often") {
  const RandomStream of_pixel(1, 2, 0);
  for (int lamps : {2, 4, 16}) {
    std::vector<int> count(static_cast<std::size_t>(lamps), 0);
    for (std::uint32_t sample = 0; sample < 8; ++sample) {
      const LightSampleNumbers samples(of_pixel, 4 * sample);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const double choice = samples.look(i).lamp.uniform_double(0);
        ++count[static_cast<std::size_t>(choice * lamps)];
      }
    }
    for (const int looked_at : count) CHECK(looked_at == 32 / lamps);
  }
}

}  // namespace photile::test
