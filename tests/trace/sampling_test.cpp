// Random numbers and the maps from them to directions and points.
#include "trace/sampling.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "statistical_tests.hpp"
#include "trace/random_stream.hpp"

namespace photile::test {

using namespace photile::trace;

namespace {

constexpr int samples = 200'000;
constexpr std::uint64_t seed = 20121;

std::size_t bin(double part, int bins) {
  return std::min(static_cast<std::size_t>(part * bins), static_cast<std::size_t>(bins - 1));
}

double turn(const glm::vec3& v) { return std::atan2(v.y, v.x) / (2 * M_PI) + 0.5; }

}  // namespace

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

}  // namespace photile::test
