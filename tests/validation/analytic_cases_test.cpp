// The cases of `photile validate` and their verdicts.
#include "validation/analytic_cases.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "estimates_comparison.hpp"
#include "test_device.hpp"
#include "validation/validate.hpp"

namespace photile::test {
namespace {

using namespace photile::validation;

// The analytic cases of `photile validate`, with fewer photons and the bounds of a t test.

/// What the midpoint rule over sensors, and rounding to float, may add to an error.
constexpr double slack = 1e-3;

/// CHECKs that a mean of 16 seeds or more is what was expected: Student's t, two-sided 1e-6 (7.90
/// for 16). FAILs where a deviation of `delta` could be missed.
void check(const ValidationRow& row, const validation::Measured& measured, double delta) {
  const double error = measured.noise / student_t_99(measured.seeds - 1);
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
  parameters.most_seeds = fewest_seeds;
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

TEST_CASE("paths read what closed forms say, in every analytic case", "[slow]") {
  ValidationParameters parameters;
  parameters.by_photons = false;
  parameters.paths = 200'000;
  parameters.most_seeds = fewest_seeds;
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

// What validation makes of sixteen readings: within 1%, beyond it, or too noisy to tell.

/// Sixteen values of this mean whose standard deviation is `scatter`.
std::vector<double> values(double mean, double scatter) {
  std::vector<double> result;
  for (int i = 0; i < 16; ++i) {
    result.push_back(mean + (i % 2 == 0 ? 1 : -1) * scatter * std::sqrt(15.0 / 16.0));
  }
  return result;
}

TEST_CASE("the noise of a reading is the 99% interval of its mean") {
  const validation::Measured result = measured(values(200, 4), 100);
  CHECK(result.value == Approx(200));
  CHECK(result.error == Approx(1));
  CHECK(result.noise == Approx(2.94671 * 4 / std::sqrt(16.0) / 100));  // t table, 15 degrees
}

TEST_CASE("deviations that 1% of means exceed are those of the tables of Student's t") {
  // Two-sided 99%, of 8, 15, 30 and 120 degrees of freedom.
  CHECK(student_t_99(8) == Approx(3.3554).epsilon(1e-3));
  CHECK(student_t_99(15) == Approx(2.9467).epsilon(1e-4));
  CHECK(student_t_99(30) == Approx(2.7500).epsilon(1e-4));
  CHECK(student_t_99(120) == Approx(2.6174).epsilon(1e-4));
}

TEST_CASE("more seeds are taken only where the noise leaves it open, as many as it asks for") {
  const auto reading = [](double error, double noise, validation::Verdict verdict) {
    return validation::Measured{.error = error, .noise = noise, .seeds = 16, .verdict = verdict};
  };
  const validation::Measured good = reading(0.001, 0.005, validation::Verdict::within);
  const validation::Measured bad = reading(0.05, 0.01, validation::Verdict::misses);
  CHECK(seeds_to_tell(std::vector{good, bad}) == 0);
  // The noise has to fall from 1% to 0.8%: by 1.25^2, and a tenth.
  const validation::Measured open = reading(-0.002, 0.01, validation::Verdict::too_noisy);
  CHECK(seeds_to_tell(std::vector{good, open}) == std::ceil(16 * 1.1 * 1.25 * 1.25));
  CHECK(seeds_to_tell(std::vector{open, reading(0.0, 0.5, validation::Verdict::too_noisy)}) == 32);
  CHECK(seeds_to_tell(std::vector{reading(0.0, 0.01001, validation::Verdict::too_noisy)}) == 18);
}

TEST_CASE("a case whose first seeds are too noisy takes more, and ends within 1%") {
  ValidationParameters parameters;
  parameters.by_photons = false;
  parameters.paths = 3'000;
  const auto first = [&] {
    ValidationParameters few = parameters;
    few.most_seeds = fewest_seeds;
    return rows_of("perpendicular rectangles", few).at(0).paths.value();
  }();
  const auto enough = rows_of("perpendicular rectangles", parameters).at(0).paths.value();
  CHECK(first.verdict == validation::Verdict::too_noisy);
  CHECK(first.seeds == fewest_seeds);
  CHECK(enough.verdict == validation::Verdict::within);
  CHECK(enough.seeds > fewest_seeds);
  CHECK(std::abs(enough.error) + enough.noise <= tolerance);
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

// The reflectance of the glossy material in a white furnace against an integral over directions.

/// Integral of f cos over directions at `cosine` to the normal, seen along it: the model as
/// photile/device/bsdf.h states it, by the midpoint rule over the cosine.
double integral(double albedo, double f0, double alpha) {
  constexpr int steps = 400'000;
  constexpr double pi = glm::pi<double>();
  const double a2 = alpha * alpha;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    const double half = std::sqrt((1 + cosine) / 2);  // n.h and i.h
    const double fresnel = f0 + (1 - f0) * std::pow(1 - half, 5);
    const double d = a2 / (pi * std::pow(half * half * (a2 - 1) + 1, 2));
    const double g1 = 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
    const double diffuse = photile::test::diffuse_bsdf(cosine, 1, albedo, f0, 1, alpha);
    const double f = diffuse + fresnel * d * g1 / (4 * cosine);
    sum += f * cosine * 2 * pi / steps;
  }
  return sum;
}

TEST_CASE("glossy reflectance is the integral of the BSDF") {
  using photile::validation::glossy_reflectance;
  for (const double alpha : {0.1, 0.4, 1.0}) {
    CHECK(glossy_reflectance(0.3, 0.5, alpha) == Approx(integral(0.3, 0.5, alpha)).epsilon(1e-4));
    CHECK(glossy_reflectance(0.0, 1.0, alpha) == Approx(integral(0.0, 1.0, alpha)).epsilon(1e-4));
  }
}

TEST_CASE("white surfaces reflect all light at any roughness, but for the error of the fit") {
  using photile::validation::glossy_reflectance;
  for (const double alpha : {0.02, 0.1, 0.25, 0.5, 1.0}) {
    CAPTURE(alpha);
    CHECK(glossy_reflectance(1.0, 0.04, alpha) == Approx(1.0).epsilon(0.015));
    CHECK(glossy_reflectance(0.0, 1.0, alpha) == Approx(1.0).epsilon(0.035));  // a white metal
  }
}

}  // namespace
}  // namespace photile::test
