#include "validation/glossy_reflectance.hpp"

#include <cmath>

#include "photile/device/bsdf.h"
#include "trace/diffuse_part.hpp"

namespace photile::validation {
namespace {

/// What the base and several facets reflect of light from all directions.
double diffuse_reflectance(double albedo, double f0, double alpha) {
  constexpr int steps = 20'000;
  const auto a = static_cast<float>(alpha), f = static_cast<float>(f0);
  const trace::DiffusePart part =
      trace::diffuse_part({glm::vec3(static_cast<float>(albedo)), glm::vec3(f), 1.0f, a}, 1.0f);
  PhotileAlbedoFit fit;
  photile_albedo_fit(a, &fit);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    float f0_weight = 0, f90_weight = 0;
    photile_lobe_albedo(&fit, static_cast<float>(std::sqrt((i + 0.5) / steps)), &f0_weight,
                        &f90_weight);
    sum += double{photile_diffuse(part[0].r, part[1].r, part[2].r, f0_weight, f90_weight)};
  }
  return double{PHOTILE_PI} * sum / steps;
}

}  // namespace

double glossy_reflectance(double albedo, double f0, double alpha) {
  constexpr int steps = 200'000;
  const double a2 = alpha * alpha;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps;
    // The lobe over half vectors h drawn with the density D (n.h), which inverts to this cosine.
    // The view is along n, so v.h = n.h and dw_i = 4 (v.h) dw_h: what is left of f (n.i) is F G2 /
    // n.i, where Smith's G2 with one direction along the normal is G1 of the other.
    const double n_dot_h = std::sqrt((1 - u) / (1 + (a2 - 1) * u));
    const double n_dot_i = 2 * n_dot_h * n_dot_h - 1;
    if (n_dot_i > 0) {
      const double masking = 2 / (1 + std::sqrt(1 - a2 + a2 / (n_dot_i * n_dot_i)));
      sum += (f0 + (1 - f0) * std::pow(1 - n_dot_h, 5)) * masking;
    }
  }
  return sum / steps + diffuse_reflectance(albedo, f0, alpha);
}

}  // namespace photile::validation
