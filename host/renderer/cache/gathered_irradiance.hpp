// Irradiance at points of surfaces, per light, with what is known of its error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "photile/estimator.hpp"

namespace photile::cache {

/// Each value is the mean of batches that are independent of each other. They are kept, so that the
/// error of any mix of lights is known, and that of what is averaged over points.
struct GatheredIrradiance {
  /// Irradiance alone, each layer at power 1, in the form of Estimates.
  Estimates mean;
  int batches = 0;
  /// Luminance that each batch alone gives, row-major [estimate][batch].
  std::vector<float> batch;
  /// Variance of the luminance that all batches share, of caustics; empty where there are none.
  std::vector<float> shared_variance;

  std::uint64_t bytes() const;

  std::size_t points(std::size_t lights) const {
    return mean.first.empty() ? mean.irradiance.size() / lights : mean.first.size() - 1;
  }

  /// Standard error of the luminance of one estimate.
  double error(std::size_t estimate) const;

  /// Luminance of all lights together, and its standard error.
  struct Total {
    double luminance = 0, error = 0;
  };
  /// At a point, with these powers of the layers.
  Total total(std::size_t point, std::span<const double> layer_powers) const;

  /// Appends what `other` has of one of its points.
  void append(const GatheredIrradiance& other, std::size_t point, std::size_t lights);
  /// Appends all points of `other`, which has as many batches.
  void append(GatheredIrradiance other);
};

/// Light of two kinds at the same points, whose batches are as many.
GatheredIrradiance sum_of(const GatheredIrradiance& a, const GatheredIrradiance& b,
                          std::size_t lights);

}  // namespace photile::cache
