// The reflectance of the glossy material in a white furnace against an integral over directions.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "estimates_comparison.hpp"
#include "validation/analytic_cases.hpp"

namespace photile::test {
namespace {

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

}  // namespace

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

}  // namespace photile::test
