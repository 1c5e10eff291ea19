// How the estimate narrows from pass to pass, and into how many passes photons are split.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "photile/limits.hpp"
#include "render/pass_count.hpp"

namespace photile::test {
namespace {

constexpr std::uint64_t gib = 1ull << 30;

/// The product of (i + alpha) / (i + 1) for i = 1 ... pass.
double gamma_ratio(int pass, double alpha) {
  return std::exp(std::lgamma(pass + 1 + alpha) - std::lgamma(1 + alpha) - std::lgamma(pass + 2.0));
}

}  // namespace

TEST_CASE("the squared radius shrinks as Knaus and Zwicker's, in closed form") {
  for (const int pass : {0, 1, 2, 9, 99, 9'999}) {
    const double radius = estimate_of_pass(pass, {0.5, 50}).radius;
    CHECK(radius * radius == Approx(0.25 * gamma_ratio(pass, 2.0 / 3.0)).epsilon(1e-9));
  }
  CHECK(estimate_of_pass(0, {0.5, 50}).radius == 0.5);
  CHECK(estimate_of_pass(0, {0.5, 50}).neighbours == 50);
}

TEST_CASE("k shrinks with the squared radius, down to its least") {
  for (const int pass : {1, 10, 100}) {
    const PassEstimate estimate = estimate_of_pass(pass, {2.0, 1000});
    CHECK(estimate.neighbours == Approx(250 * estimate.radius * estimate.radius).margin(0.5));
  }
  CHECK(estimate_of_pass(10'000, {1.0, 50}).neighbours == 5);
  CHECK(estimate_of_pass(10'000, {1.0, 3}).neighbours == 3);
}

TEST_CASE("photons of a pass take at most half of the memory") {
  // 10 photons of 100 bytes a path: 1 GiB / 2 holds 536,870 paths.
  CHECK(passes_within(500'000, 10, 100, gib) == 1);
  CHECK(passes_within(536'870, 10, 100, gib) == 1);
  CHECK(passes_within(536'871, 10, 100, gib) == 2);
  CHECK(passes_within(5'368'000, 10, 100, gib) == 10);
  CHECK(passes_within(1, 10, 100, 0) == 10);
  CHECK(passes_within(1000, 0, 100, gib) == 1);
}

TEST_CASE("photons of a pass can be indexed, whatever the memory") {
  const std::uint64_t paths = limits::max_emitted_photons;
  const int passes = passes_within(paths, 6.0, 100, ~0ull);
  CHECK(passes > 1);
  CHECK(static_cast<double>(paths) / passes * 6.0 <
        static_cast<double>(limits::max_stored_photons));
}

TEST_CASE("more passes than the limit allows are seen as such") {
  CHECK(passes_within(limits::max_emitted_photons, 100, 100, 1000) > limits::max_passes);
}

TEST_CASE("the host's memory is known, and the same however much of it is in use") {
  const std::uint64_t before = installed_host_bytes();
  const std::vector<char> taken(64u << 20, 1);
  CHECK(before > (1u << 20));
  CHECK(before < (std::uint64_t{1} << 50));
  CHECK(installed_host_bytes() == before);
  CHECK(taken.back() == 1);
}

}  // namespace photile::test
