// The steps of illuminance that standards count in.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace photile::report {

/// The values between two illuminances of the scale of EN 12464-1, whose steps are of about 1.5:
/// 5, 7.5, 10, 15, 20, 30, 50, 75, 100, ..., ascending. Lux, or whatever unit.
///   low, high   >= 0; nothing is below a thousandth of `high`
inline std::vector<double> illuminance_steps(double low, double high) {
  std::vector<double> steps;
  if (!(high > 0) || !std::isfinite(high)) return steps;
  const double least = std::max(low, high / 1000);
  for (double decade = std::pow(10, std::floor(std::log10(least))); decade < high; decade *= 10) {
    for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.5}) {
      if (step * decade > least && step * decade < high) steps.push_back(step * decade);
    }
  }
  return steps;
}

}  // namespace photile::report
