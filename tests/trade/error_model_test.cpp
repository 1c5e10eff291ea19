#include "tools/trade/error_model.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace photile::test {
namespace {

/// What pilots would measure where the model holds exactly.
trade::PilotErrors exact_pilot(const ErrorModel& model, double photons, double samples) {
  trade::PilotErrors pilot;
  pilot.neighbours = {16, 64, 256};
  pilot.photons = photons;
  pilot.samples = samples;
  const auto bias = [&](double k) {
    return std::sqrt(model.bias * std::pow(k / photons, model.exponent));
  };
  for (const double k : pilot.neighbours) {
    pilot.variance.push_back(model.noise / (k - 2) + model.sampling / samples);
    auto& row = pilot.squared_bias_difference.emplace_back();
    for (const double other : pilot.neighbours) {
      row.push_back(std::pow(bias(k) - bias(other), 2));
    }
  }
  return pilot;
}

}  // namespace

TEST_CASE("the error model is found from measurements that follow it") {
  const ErrorModel truth = GENERATE(ErrorModel{1.2, 0.004, 30.0, 1.0}, ErrorModel{2.0, 0, 2.0, 0.5},
                                    ErrorModel{1.1, 0.01, 500.0, 2.0});
  const ErrorModel found = trade::fit_error_model(exact_pilot(truth, 200'000, 4));
  CHECK(found.noise == Approx(truth.noise).epsilon(1e-6));
  CHECK(found.sampling == Approx(truth.sampling).margin(1e-9));
  CHECK(found.exponent == truth.exponent);
  CHECK(found.bias == Approx(truth.bias).epsilon(1e-6));
  // Also where no pilot was: other photons, k and samples.
  CHECK(found.relative_mse(1e7, 1000, 16) == Approx(truth.noise / 998 + truth.sampling / 16 +
                                                    truth.bias * std::pow(1e-4, truth.exponent)));
}

TEST_CASE("no term of the error model is negative, whatever noise the pilots had") {
  trade::PilotErrors pilot = exact_pilot({1.0, 0.001, 0, 1}, 1e5, 4);
  pilot.variance.back() /= 2;  // below what noise / (k - 2) + sampling can follow
  for (auto& row : pilot.squared_bias_difference) {
    for (double& value : row) value = -1e-5;
  }
  const ErrorModel found = trade::fit_error_model(pilot);
  CHECK(found.noise > 0);
  CHECK(found.sampling >= 0);
  CHECK(found.bias == 0);
}

}  // namespace photile::test
