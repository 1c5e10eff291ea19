// Means of the light of several points.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "gather/gathered_irradiance.hpp"
#include "render/reflected_radiance.hpp"

namespace photile::gathering {

/// Weighted means of points, written one after another.
class WeightedPoints {
 public:
  /// `to` is empty.
  ///   like   batches, and form, of all points
  WeightedPoints(std::size_t lights, const GatheredIrradiance& like, GatheredIrradiance& to)
      : to_(to),
        sparse_(!like.mean.first.empty()),
        shared_(!like.shared_variance.empty()),
        batches_(static_cast<std::size_t>(like.batches)),
        irradiance_(lights, glm::dvec3(0.0)),
        batch_(lights * batches_, 0.0),
        variance_(lights, 0.0),
        is_lit_(lights) {
    to_.batches = like.batches;
    if (sparse_) to_.mean.first.push_back(0);
  }

  void add(const GatheredIrradiance& from, std::size_t point, double weight) {
    weights_ += weight;
    for_each_estimate(from.mean, point, is_lit_.size(), [&](std::size_t layer, std::size_t i) {
      if (!is_lit_[layer]) {
        is_lit_[layer] = 1;
        lit_.push_back(static_cast<std::uint16_t>(layer));
      }
      irradiance_[layer] += weight * glm::dvec3(from.mean.irradiance[i]);
      for (std::size_t b = 0; b < batches_; ++b) {
        batch_[layer * batches_ + b] += weight * double{from.batch[i * batches_ + b]};
      }
      // Photons of caustics may be the same at all points: errors add up.
      if (shared_) {
        variance_[layer] += weight * std::sqrt(double{from.shared_variance[i]});
      }
    });
  }

  void end_point() {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t layer : lit_) write(layer);
    if (sparse_) to_.mean.first.push_back(to_.mean.irradiance.size());
    lit_.clear();
    weights_ = 0;
  }

 private:
  void write(std::uint16_t layer) {
    to_.mean.irradiance.emplace_back(irradiance_[layer] / weights_);
    if (sparse_) to_.mean.light.push_back(layer);
    for (std::size_t b = 0; b < batches_; ++b) {
      double& sum = batch_[layer * batches_ + b];
      to_.batch.push_back(static_cast<float>(sum / weights_));
      sum = 0;
    }
    if (shared_) {
      const double error = variance_[layer] / weights_;
      to_.shared_variance.push_back(static_cast<float>(error * error));
    }
    irradiance_[layer] = glm::dvec3(0.0);
    variance_[layer] = 0;
    is_lit_[layer] = 0;
  }

  GatheredIrradiance& to_;
  bool sparse_, shared_;
  std::size_t batches_;
  double weights_ = 0;
  std::vector<glm::dvec3> irradiance_;  ///< per layer
  std::vector<double> batch_;           ///< [layer][batch]
  std::vector<double> variance_;        ///< per layer: of standard errors
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

}  // namespace photile::gathering
