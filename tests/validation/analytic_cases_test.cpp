// The analytic cases of `photile validate`, with fewer photons and the bounds of a t test.
#include <catch2/catch.hpp>

#include "test_device.hpp"
#include "validation/validate.hpp"

using namespace photile;
using namespace photile::validation;

namespace {

/// What the midpoint rule over sensors, and rounding to float, may add to an error.
constexpr double slack = 1e-3;

/// CHECKs that a mean of 16 seeds is what was expected: Student's t, two-sided 1e-6 (7.90; the
/// noise is that of 2.947). FAILs where a deviation of `delta` could be missed.
void check(const ValidationRow& row, const Measured& measured, double delta) {
  const double error = measured.noise / 2.947;
  INFO(row.name << ", " << row.place << ": expected " << row.expected << ", error "
                << measured.error << " +- " << error);
  if ((7.90 + 3.1) * error > delta) FAIL("too noisy to see " << delta);
  CHECK(std::abs(measured.error) <= 7.90 * error + slack);
}

ValidationParameters few_photons(std::uint64_t photons, int neighbours) {
  ValidationParameters parameters;
  parameters.photons.photons.emitted_photons = photons;
  parameters.photons.neighbours = neighbours;
  parameters.by_paths = false;
  return parameters;
}

std::vector<ValidationRow> rows_of(const std::string& name,
                                   const ValidationParameters& parameters) {
  for (const AnalyticCase& analytic : analytic_cases()) {
    if (analytic.name != name) continue;
    return validate(analytic, std::span(&test::device(), parameters.by_photons ? 1 : 0), parameters,
                    Progress::none());
  }
  throw std::logic_error("no case " + name);
}

}  // namespace

TEST_CASE("paths read what closed forms say, in every analytic case", "[slow]") {
  ValidationParameters parameters;
  parameters.by_photons = false;
  parameters.paths = 150'000;
  for (const AnalyticCase& analytic : analytic_cases()) {
    for (const ValidationRow& row : validate(analytic, {}, parameters, Progress::none())) {
      REQUIRE(row.paths);
      check(row, *row.paths, 0.04);
    }
  }
}

TEST_CASE("every analytic case has one light, sensors and something to expect") {
  for (const AnalyticCase& analytic : analytic_cases()) {
    INFO(analytic.name);
    CHECK(analytic.scene.lights.size() == 1);
    CHECK(analytic.scene.lights[0].power > 0);
    CHECK_FALSE(analytic.readings.empty());
    for (const Reading& reading : analytic.readings) {
      CHECK_FALSE(reading.sensors.empty());
      CHECK(reading.expected > 0);
    }
  }
}

TEST_CASE("photon maps read what closed forms say where no disc is cut") {
  const auto [name, delta] =
      GENERATE(table<std::string, double>({{"point light over a surface", 0.08},
                                           {"area light over a surface", 0.08},
                                           {"diffuse reflection", 0.15},
                                           {"diffuse reflection with an obstruction", 0.18},
                                           {"integrating sphere, rho = 0.9", 0.03}}));
  for (const ValidationRow& row : rows_of(name, few_photons(600'000, 100))) {
    check(row, *row.photons, delta);
  }
}
