// The reflectance of the glossy material in a white furnace against an integral over directions.
#include "validation/glossy_reflectance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace {

/// Integral of f cos over directions at `cosine` to the normal, seen along it: the model as
/// photile/device/bsdf.h states it, by the midpoint rule over the cosine.
double integral(double albedo, double f0, double alpha) {
  constexpr int steps = 2'000'000;
  constexpr double pi = glm::pi<double>();
  const double a2 = alpha * alpha;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    const double half = std::sqrt((1 + cosine) / 2);  // n.h and i.h
    const double fresnel = f0 + (1 - f0) * std::pow(1 - half, 5);
    const double d = a2 / (pi * std::pow(half * half * (a2 - 1) + 1, 2));
    const double g1 = 2 * cosine / (cosine + std::sqrt(a2 + (1 - a2) * cosine * cosine));
    const double f = (1 - fresnel) * albedo / pi + fresnel * d * g1 / (4 * cosine);
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
  CHECK(glossy_reflectance(0.7, 0.0, 0.5) < 0.7);  // Schlick's reflection takes from the base
}
