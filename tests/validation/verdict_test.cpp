// What validation makes of sixteen readings: within 1%, beyond it, or too noisy to tell.
#include <catch2/catch.hpp>

#include "validation/validate.hpp"

namespace photile::test {

using namespace photile::validation;

namespace {

/// Sixteen values of this mean whose standard deviation is `scatter`.
std::vector<double> values(double mean, double scatter) {
  std::vector<double> result;
  for (int i = 0; i < seeds; ++i) {
    result.push_back(mean + (i % 2 == 0 ? 1 : -1) * scatter * std::sqrt(15.0 / 16.0));
  }
  return result;
}

}  // namespace

TEST_CASE("the noise of a reading is the 99% interval of its mean") {
  const validation::Measured result = measured(values(200, 4), 100);
  CHECK(result.value == Approx(200));
  CHECK(result.error == Approx(1));
  CHECK(result.noise == Approx(2.947 * 4 / std::sqrt(16.0) / 100));  // t table, 15 degrees
}

TEST_CASE("a reading is within 1% only if its noise leaves no doubt") {
  CHECK(measured(values(1.004, 0.002), 1).verdict == validation::Verdict::within);
  CHECK(measured(values(0.996, 0.002), 1).verdict == validation::Verdict::within);
  CHECK(measured(values(1.004, 0.02), 1).verdict == validation::Verdict::too_noisy);
  CHECK(measured(values(1.0, 0.02), 1).verdict == validation::Verdict::too_noisy);
  CHECK(measured(values(1.011, 0.01), 1).verdict == validation::Verdict::too_noisy);
}

TEST_CASE("a reading misses if no noise explains its error") {
  CHECK(measured(values(1.02, 0.005), 1).verdict == validation::Verdict::misses);
  CHECK(measured(values(0.98, 0.005), 1).verdict == validation::Verdict::misses);
  CHECK(measured(values(1.0101, 0), 1).verdict == validation::Verdict::misses);
}

}  // namespace photile::test
