// Means of the light of several points, each layer with weights of its own.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "cache/gathered_irradiance.hpp"
#include "cache/likeness.hpp"
#include "estimate/reflected_radiance.hpp"

namespace photile::cache {

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
        sums_(lights),
        batch_(lights * batches_, 0.0) {
    to_.batches = like.batches;
    if (sparse_) to_.mean.first.push_back(0);
  }

  /// Adds a point to the mean.
  ///   weight_of   of a layer, by its number
  ///   of_none     weight that it would give to a layer that no point so far has
  template <class Weight>
  void add(const GatheredIrradiance& from, std::size_t point, double of_none,
           const Weight& weight_of) {
    estimate::for_each_estimate(from.mean, point, sums_.size(),
                                [&](std::size_t layer, std::size_t) { light(layer); });
    smooth_ = smooth_ || !from.mean.by_normal.empty();
    for (const std::uint16_t layer : lit_) {
      sums_[layer].weight = weight_of(layer);
      sums_[layer].weights += sums_[layer].weight;
    }
    estimate::for_each_estimate(
        from.mean, point, sums_.size(), [&](std::size_t layer, std::size_t i) {
          Sums& sums = sums_[layer];
          sums.irradiance += sums.weight * glm::dvec3(from.mean.irradiance[i]);
          if (smooth_) sums.by_normal += sums.weight * glm::dvec4(from.mean.by_normal[i]);
          for (std::size_t b = 0; b < batches_; ++b) {
            batch_[layer * batches_ + b] += sums.weight * double{from.batch[i * batches_ + b]};
          }
          // Photons of caustics may be the same at all points: errors add up.
          if (shared_) sums.error += sums.weight * std::sqrt(double{from.shared_variance[i]});
        });
    of_none_ += of_none;
  }

  void end_point() {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t layer : lit_) write(layer);
    if (sparse_) to_.mean.first.push_back(to_.mean.irradiance.size());
    lit_.clear();
    of_none_ = 0;
  }

 private:
  void light(std::size_t layer) {
    if (sums_[layer].is_lit) return;
    sums_[layer].is_lit = true;
    sums_[layer].weights = of_none_;
    lit_.push_back(static_cast<std::uint16_t>(layer));
  }

  /// Of one layer, weighted.
  struct Sums {
    glm::dvec3 irradiance{0.0};
    glm::dvec4 by_normal{0.0};
    double error = 0;  ///< that all batches share
    double weights = 0;
    double weight = 0;  ///< of the point that is being added
    bool is_lit = false;
  };

  void write(std::uint16_t layer) {
    Sums& sums = sums_[layer];
    to_.mean.irradiance.emplace_back(sums.irradiance / sums.weights);
    if (smooth_) to_.mean.by_normal.emplace_back(sums.by_normal / sums.weights);
    if (sparse_) to_.mean.light.push_back(layer);
    for (std::size_t b = 0; b < batches_; ++b) {
      double& sum = batch_[layer * batches_ + b];
      to_.batch.push_back(static_cast<float>(sum / sums.weights));
      sum = 0;
    }
    if (shared_) {
      const double error = sums.error / sums.weights;
      to_.shared_variance.push_back(static_cast<float>(error * error));
    }
    sums = {};
  }

  GatheredIrradiance& to_;
  bool sparse_, shared_;
  bool smooth_ = false;  ///< once a point tells light by the normal, as all do that have light
  std::size_t batches_;
  std::vector<Sums> sums_;     ///< per layer
  std::vector<double> batch_;  ///< [layer][batch], weighted
  std::vector<std::uint16_t> lit_;
  double of_none_ = 0;
};

/// A place and those around it, of which it becomes the mean.
class MeanOfPlaces {
 public:
  MeanOfPlaces(std::span<const double> layer_powers, const GatheredIrradiance& like,
               GatheredIrradiance& to)
      : sums_(layer_powers.size(), like, to),
        own_(layer_powers),
        other_(layer_powers),
        likeness_(layer_powers) {}

  void add_own(const GatheredIrradiance& from, std::size_t point) {
    own_.read(from, point);
    sums_.add(from, point, 1.0, [](std::size_t) { return 1.0; });
  }
  /// One that may have the same light; as heavy as so many.
  void add_other(const GatheredIrradiance& from, std::size_t point, const NoiseTolerance& tolerated,
                 double weight = 1) {
    other_.read(from, point);
    likeness_.compare(own_, other_, tolerated);
    sums_.add(from, point, weight * likeness_.of_others(),
              [&](std::size_t layer) { return weight * likeness_.of_layer(layer); });
  }
  void end_place() { sums_.end_point(); }

 private:
  WeightedPoints sums_;
  KnownLight own_, other_;
  Likeness likeness_;
};

/// Means that add(i, mean) makes of each of so many places; `like` has their batches and form.
template <class Add>
GatheredIrradiance means_of(const GatheredIrradiance& like, std::size_t count,
                            std::span<const double> layer_powers, const Add& add) {
  // Large enough to make a task's cost vanish, small enough to share work.
  constexpr std::size_t per_task = 256;
  std::vector<GatheredIrradiance> parts((count + per_task - 1) / per_task);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    MeanOfPlaces mean(layer_powers, like, parts[part]);
    const std::size_t last = std::min(count, (part + 1) * per_task);
    for (std::size_t i = part * per_task; i < last; ++i) {
      add(i, mean);
      mean.end_place();
    }
  });
  GatheredIrradiance all;
  all.batches = like.batches;
  if (!like.mean.first.empty()) all.mean.first.push_back(0);
  for (GatheredIrradiance& part : parts) all.append(std::move(part));
  return all;
}

}  // namespace photile::cache
