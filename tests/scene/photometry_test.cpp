#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "scene/light_emission.hpp"

namespace photile::test {
namespace {

using std::numbers::pi;

/// The spot falloff of KHR_lights_punctual, integrated over the sphere by the midpoint rule.
double integrated_spot_flux(double intensity, double inner, double outer) {
  constexpr int steps = 200'000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double angle = outer * (i + 0.5) / steps;
    const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    const double attenuation = std::clamp(ramp, 0.0, 1.0);
    sum += 2.0 * pi * std::sin(angle) * attenuation * attenuation * intensity * outer / steps;
  }
  return sum;
}

TEST_CASE("spot flux is the integral of its falloff over the sphere") {
  CHECK(scene::spot_flux(3.0, 0.0, 0.7853981634) ==
        Approx(integrated_spot_flux(3.0, 0.0, 0.7853981634)).epsilon(1e-6));
  CHECK(scene::spot_flux(3.0, 0.4, 1.2) ==
        Approx(integrated_spot_flux(3.0, 0.4, 1.2)).epsilon(1e-6));
}

TEST_CASE("a spot without a ramp over the half sphere has half the flux of a point light") {
  CHECK(2.0 * scene::spot_flux(5.0, pi / 2, pi / 2) == Approx(scene::point_flux(5.0)));
}

TEST_CASE("fluxes of area, point and directional lights are their closed forms") {
  CHECK(scene::area_flux(10.0, 2.0, false) == Approx(20.0 * pi));
  CHECK(scene::area_flux(10.0, 2.0, true) == Approx(40.0 * pi));
  CHECK(scene::point_flux(1.0) == Approx(4.0 * pi));
  CHECK(scene::directional_flux(1000.0, 3.0) == Approx(9000.0 * pi));
}

}  // namespace
}  // namespace photile::test
