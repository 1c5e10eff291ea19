// Random numbers, Sobol points and orders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "geometry/radix_sort.hpp"
#include "statistical_tests.hpp"
#include "trace/direct_light.hpp"
#include "trace/random_stream.hpp"
#include "trace/sampling.hpp"

namespace photile::test {
namespace {

using namespace trace;

// Scrambled Sobol points: nets, uniformity, known integrals, errors.

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

TEST_CASE(
    "The light samples of a pixel's samples share their sequences and take every light as often") {
  const RandomStream of_pixel(1, 2, 0);
  for (int lamps : {2, 4, 16}) {
    std::vector<int> count(static_cast<std::size_t>(lamps), 0);
    for (std::uint32_t sample = 0; sample < 8; ++sample) {
      const LightSampleNumbers samples(of_pixel, 4 * sample);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const double choice = samples.sample(i).choice.uniform_double(0);
        ++count[static_cast<std::size_t>(choice * lamps)];
      }
    }
    for (const int looked_at : count) CHECK(looked_at == 32 / lamps);
  }
}

// Random numbers and the maps from them to directions and points.

constexpr int samples = 200'000;
constexpr std::uint64_t seed = 20121;

std::size_t bin(double part, int bins) {
  return std::min(static_cast<std::size_t>(part * bins), static_cast<std::size_t>(bins - 1));
}

double turn(const glm::vec3& v) { return std::atan2(v.y, v.x) / (2 * M_PI) + 0.5; }

TEST_CASE("Philox4x32-10 gives the known answers of the Random123 distribution") {
  CHECK(philox4x32_10({0, 0, 0, 0}, {0, 0}) ==
        PhiloxCounter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  const std::uint32_t ones = 0xffffffff;
  CHECK(philox4x32_10({ones, ones, ones, ones}, {ones, ones}) ==
        PhiloxCounter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        PhiloxCounter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Random blocks of different seeds, paths, streams, purposes and bounces all differ") {
  std::set<double> values;
  std::size_t drawn = 0;
  const auto draw = [&](std::uint64_t s, std::uint64_t path, std::uint32_t stream, Purpose purpose,
                        std::uint32_t index) {
    values.insert(RandomStream(s, path, stream).block(purpose, index).uniform_double(0));
    ++drawn;
  };
  for (const std::uint64_t s : {1ull, 2ull, 1ull << 32})
    for (const std::uint64_t path : {0ull, 1ull, 1ull << 16, 1ull << 32, (1ull << 48) - 1})
      for (const std::uint32_t stream : {0u, 1u, 65535u})
        for (const Purpose purpose : {Purpose::emission, Purpose::photon_scattering})
          for (const std::uint32_t index : {0u, 1u, 64u}) draw(s, path, stream, purpose, index);
  CHECK(values.size() == drawn);
}

TEST_CASE("A frame is orthonormal and right-handed for normals in every octant and on the axes") {
  for (const float x : {-1.0f, 0.0f, 1e-4f, 0.6f})
    for (const float y : {-0.7f, 0.0f, 1.0f})
      for (const float z : {-1.0f, -1e-7f, 0.0f, 0.3f}) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Frame frame(glm::normalize(glm::vec3(x, y, z)));
        CHECK(std::abs(glm::dot(frame.s, frame.t)) < 1e-6f);
        CHECK(std::abs(glm::dot(frame.s, frame.n)) < 1e-6f);
        CHECK(std::abs(glm::dot(frame.t, frame.n)) < 1e-6f);
        CHECK(glm::length(frame.s) == Approx(1).epsilon(1e-6));
        CHECK(glm::distance(glm::cross(frame.s, frame.t), frame.n) < 1e-6f);
      }
}

TEST_CASE("Cosine-weighted directions fill bins of equal projected area equally") {
  std::vector<double> counts(10 * 12, 0.0);
  for (int i = 0; i < samples; ++i) {
    const RandomBlock u = RandomStream(seed, i, 0).block(Purpose::emission, 0);
    const glm::vec3 v = sample_cosine_hemisphere(u.uniform(0), u.uniform(1));
    REQUIRE(v.z > 0);
    REQUIRE(glm::length(v) == Approx(1).epsilon(1e-5));
    ++counts[bin(v.z * v.z, 10) * 12 + bin(turn(v), 12)];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(120, samples / 120.0)));
}

TEST_CASE("Directions on the sphere fill bins of equal solid angle equally") {
  std::vector<double> counts(10 * 12, 0.0);
  for (int i = 0; i < samples; ++i) {
    const RandomBlock u = RandomStream(seed, i, 1).block(Purpose::emission, 0);
    const glm::vec3 v = sample_sphere(u.uniform(0), u.uniform(1));
    ++counts[bin(0.5 * v.z + 0.5, 10) * 12 + bin(turn(v), 12)];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(120, samples / 120.0)));
}

TEST_CASE("Points on a triangle fill its n^2 congruent parts equally") {
  constexpr int n = 8;
  std::vector<double> counts(n * n, 0.0);
  for (int i = 0; i < samples; ++i) {
    const RandomBlock r = RandomStream(seed, i, 2).block(Purpose::emission, 0);
    const glm::vec2 p = sample_triangle(r.uniform(0), r.uniform(1));
    REQUIRE(p.x >= 0);
    REQUIRE(p.y >= 0);
    REQUIRE(p.x + p.y <= 1.0f + 1e-6f);
    // Row by v; within a row, upright and inverted small triangles alternate.
    const int row = static_cast<int>(bin(p.y, n)), column = static_cast<int>(bin(p.x, n));
    const bool inverted = n * (p.x + p.y) - row - column >= 1;
    const int parts_below = row * (2 * n - row);
    ++counts[static_cast<std::size_t>(
        std::min(parts_below + 2 * column + (inverted ? 1 : 0), n * n - 1))];
  }
  CHECK_VERDICT(counts_agree(counts, std::vector<double>(n * n, samples / double{n * n})));
}

struct Item {
  std::uint64_t key;
  std::uint32_t number;
  bool operator==(const Item&) const = default;
};

TEST_CASE("A radix sort is a stable sort") {
  const std::size_t count = GENERATE(0, 1, 2, 4095, 100'000);
  const int bits = GENERATE(1, 8, 13, 64);
  CAPTURE(count, bits);
  std::mt19937_64 random(count + static_cast<std::size_t>(bits));
  std::vector<Item> items;
  for (std::size_t i = 0; i < count; ++i)
    items.push_back({random() >> (64 - bits), static_cast<std::uint32_t>(i)});
  std::vector<Item> expected = items;
  std::stable_sort(expected.begin(), expected.end(),
                   [](const Item& a, const Item& b) { return a.key < b.key; });
  geometry::radix_sort(items, bits, [](const Item& item) { return item.key; });
  CHECK((items == expected));
}

}  // namespace
}  // namespace photile::test
