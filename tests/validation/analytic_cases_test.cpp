// The analytic cases of `photile validate`, with fewer photons and the bounds of a t test.
#include <catch2/catch.hpp>

#include "test_device.hpp"
#include "validation/validate.hpp"

namespace photile::test {

using namespace photile::validation;

namespace {

/// What the midpoint rule over sensors, and rounding to float, may add to an error.
constexpr double slack = 1e-3;

/// CHECKs that a mean of 16 seeds is what was expected: Student's t, two-sided 1e-6 (7.90; the
/// noise is that of 2.947). FAILs where a deviation of `delta` could be missed.
void check(const ValidationRow& row, const validation::Measured& measured, double delta) {
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
  parameters.paths = 200'000;
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

TEST_CASE("photon maps read what closed forms say") {
  // Means over whole rooms take a small share of the photons and of k.
  const auto [name, photons, neighbours, delta] = GENERATE(table<std::string, int, int, double>(
      {{"point light over a surface", 600'000, 100, 0.08},
       {"area light over a surface", 600'000, 100, 0.08},
       {"perpendicular rectangles", 2'000'000, 400, 0.04},
       {"luminous flux in a black box", 2'000'000, 400, 0.02},
       {"diffuse reflection", 600'000, 100, 0.15},
       {"diffuse reflection with an obstruction", 600'000, 100, 0.18},
       {"interreflection, rho = 0.5", 2'000'000, 400, 0.02},
       {"integrating sphere, rho = 0.9", 2'000'000, 400, 0.03}}));
  for (const ValidationRow& row :
       rows_of(name, few_photons(static_cast<std::uint64_t>(photons), neighbours))) {
    check(row, *row.photons, delta);
  }
}

}  // namespace photile::test
