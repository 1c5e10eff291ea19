#include "tools/trade/error_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace photile {
namespace trade {
namespace {

/// Exponents of k / photons in the squared bias: borders of shadows 1/2, smooth light 2.
constexpr double least_exponent = 0.5, most_exponent = 2.0, exponent_step = 0.125;

/// Variance = noise / (k - 2) + sampling, each relative to what was measured; none below zero.
void fit_variance(const PilotErrors& pilot, ErrorModel& model) {
  double aa = 0, ab = 0, bb = 0, a1 = 0, b1 = 0;
  for (std::size_t i = 0; i < pilot.neighbours.size(); ++i) {
    const double weight = 1 / pilot.variance[i];
    const double a = weight / (pilot.neighbours[i] - 2), b = weight / pilot.samples;
    aa += a * a, ab += a * b, bb += b * b, a1 += a, b1 += b;
  }
  const double determinant = aa * bb - ab * ab;
  model.noise = (a1 * bb - b1 * ab) / determinant;
  model.sampling = (b1 * aa - a1 * ab) / determinant;
  if (model.sampling < 0) model = {.noise = a1 / aa};
  if (model.noise < 0) model = {.sampling = b1 / bb};
}

/// Bias of k is f k^(exponent / 2): the differences say f^2 for a given exponent, and how well.
struct BiasFit {
  double squared = 0;  ///< f^2
  double misfit = 0;
};

BiasFit fit_bias(const PilotErrors& pilot, double exponent) {
  double mm = 0, md = 0, dd = 0;
  for (std::size_t i = 0; i < pilot.neighbours.size(); ++i) {
    for (std::size_t j = i + 1; j < pilot.neighbours.size(); ++j) {
      const double difference =
          std::pow(pilot.neighbours[j], exponent / 2) - std::pow(pilot.neighbours[i], exponent / 2);
      const double expected = difference * difference;
      const double measured = pilot.squared_bias_difference[i][j];
      mm += expected * expected, md += expected * measured, dd += measured * measured;
    }
  }
  const double squared = std::max(0.0, md / mm);
  return {squared, dd - 2 * squared * md + squared * squared * mm};
}

}  // namespace

ErrorModel fit_error_model(const PilotErrors& pilot) {
  ErrorModel model;
  fit_variance(pilot, model);
  double least_misfit = std::numeric_limits<double>::infinity();
  for (double exponent = least_exponent; exponent <= most_exponent; exponent += exponent_step) {
    const BiasFit fit = fit_bias(pilot, exponent);
    if (fit.misfit >= least_misfit) continue;
    least_misfit = fit.misfit;
    model.exponent = exponent;
    model.bias = fit.squared * std::pow(pilot.photons, exponent);
  }
  return model;
}

}  // namespace trade

double ErrorModel::relative_mse(double photons, double k, double samples) const {
  return noise / std::max(k - 2, 0.5) + sampling / samples + bias * std::pow(k / photons, exponent);
}

}  // namespace photile
