#include "validation/glossy_reflectance.hpp"

#include <cmath>

namespace photile::validation {

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
    // The base, over directions by the cosine law.
    const double half = std::sqrt(0.5 * (1 + std::sqrt(u)));
    sum += (1 - f0 - (1 - f0) * std::pow(1 - half, 5)) * albedo;
  }
  return sum / steps;
}

}  // namespace photile::validation
