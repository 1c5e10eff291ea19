// The share of each device follows its throughput.
#include "estimate/load_balance.hpp"

#include <catch2/catch.hpp>

namespace photile::test {
namespace {

constexpr std::size_t many = 1'000'000;

/// A balance after its first two rounds, on devices that take so many seconds for a hit.
estimate::LoadBalance measured(const std::vector<double>& seconds_per_hit) {
  estimate::LoadBalance balance(seconds_per_hit.size());
  for (int round = 0; round < 2; ++round) {
    const std::vector<std::size_t> cuts = balance.cuts(balance.round(many));
    for (std::size_t i = 0; i < seconds_per_hit.size(); ++i) {
      const std::size_t hits = cuts[i + 1] - cuts[i];
      // Compiling the kernels takes the first round 10 s on the last device.
      const double compiling = round == 0 && i + 1 == seconds_per_hit.size() ? 10 : 0;
      balance.record(i, hits, compiling + seconds_per_hit[i] * static_cast<double>(hits));
    }
    balance.end_round();
  }
  return balance;
}

}  // namespace

TEST_CASE("one device takes all hits at once") {
  const estimate::LoadBalance balance(1);
  CHECK(balance.round(many) == many);
  CHECK(balance.cuts(many) == std::vector<std::size_t>{0, many});
}

TEST_CASE("the first hits are few and shared evenly") {
  const estimate::LoadBalance balance(4);
  const std::size_t hits = balance.round(many);
  CHECK(hits < many / 10);
  CHECK(balance.cuts(hits) == std::vector<std::size_t>{0, hits / 4, hits / 2, 3 * hits / 4, hits});
  CHECK(balance.round(3) == 3);
}

TEST_CASE("measured devices share hits by their throughput, whatever compiling took") {
  const estimate::LoadBalance balance = measured({1e-6, 3e-6, 6e-6});
  CHECK(balance.round(many) == many);
  // Throughputs of 6 : 2 : 1.
  const std::vector<std::size_t> cuts = balance.cuts(900);
  CHECK(cuts == std::vector<std::size_t>{0, 600, 800, 900});
}

TEST_CASE("cuts ascend from nothing to all hits, for any number of hits") {
  const estimate::LoadBalance balance = measured({1e-6, 1.0, 1e-6, 2e-6});
  for (const std::size_t count : {0u, 1u, 2u, 3u, 5u, 1000u}) {
    const std::vector<std::size_t> cuts = balance.cuts(count);
    REQUIRE(cuts.size() == 5);
    CHECK(cuts.front() == 0);
    CHECK(cuts.back() == count);
    CHECK(std::is_sorted(cuts.begin(), cuts.end()));
  }
}

TEST_CASE("where no time was measured all devices share evenly") {
  const estimate::LoadBalance balance = measured({0.0, 1e-6});
  CHECK(balance.cuts(100) == std::vector<std::size_t>{0, 50, 100});
}

TEST_CASE("shares count every hit") {
  estimate::LoadBalance balance(2);
  CHECK(balance.fractions() == std::vector<double>{0, 0});
  balance.record(0, 30, 1);
  balance.record(1, 10, 1);
  balance.end_round();
  CHECK(balance.fractions() == std::vector<double>{0.75, 0.25});
}

}  // namespace photile::test
