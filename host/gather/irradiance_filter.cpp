#include "gather/irradiance_filter.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/reflected_radiance.hpp"

namespace photile {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t filtered_per_task = 256;

/// Weight of a neighbour; that of the point itself is 1.
double weight_of(const GatheredIrradiance::Total& a, const GatheredIrradiance::Total& b,
                 double tolerated_errors) {
  const double difference = a.luminance - b.luminance;
  if (difference == 0) return 1;
  const double variance = a.error * a.error + b.error * b.error;
  return std::exp(-difference * difference / (tolerated_errors * tolerated_errors * variance));
}

/// Weighted sums of points, written one after another.
class WeightedPoints {
 public:
  WeightedPoints(const GatheredIrradiance& from, std::size_t lights, GatheredIrradiance& to)
      : from_(from),
        to_(to),
        batches_(static_cast<std::size_t>(from.batches)),
        irradiance_(lights, glm::dvec3(0.0)),
        batch_(lights * batches_, 0.0),
        variance_(lights, 0.0),
        is_lit_(lights) {
    to_.batches = from.batches;
    if (sparse()) to_.mean.first.push_back(0);
  }

  void add(std::size_t point, double weight) {
    weights_ += weight;
    for_each_estimate(from_.mean, point, is_lit_.size(), [&](std::size_t layer, std::size_t i) {
      if (!is_lit_[layer]) {
        is_lit_[layer] = 1;
        lit_.push_back(static_cast<std::uint16_t>(layer));
      }
      irradiance_[layer] += weight * glm::dvec3(from_.mean.irradiance[i]);
      for (std::size_t b = 0; b < batches_; ++b) {
        batch_[layer * batches_ + b] += weight * double{from_.batch[i * batches_ + b]};
      }
      // Photons of caustics may be the same at all points: errors add up.
      if (!from_.shared_variance.empty()) {
        variance_[layer] += weight * std::sqrt(double{from_.shared_variance[i]});
      }
    });
  }

  void end_point() {
    std::sort(lit_.begin(), lit_.end());
    for (const std::uint16_t layer : lit_) write(layer);
    if (sparse()) to_.mean.first.push_back(to_.mean.irradiance.size());
    lit_.clear();
    weights_ = 0;
  }

 private:
  bool sparse() const { return !from_.mean.first.empty(); }

  void write(std::uint16_t layer) {
    to_.mean.irradiance.emplace_back(irradiance_[layer] / weights_);
    if (sparse()) to_.mean.light.push_back(layer);
    for (std::size_t b = 0; b < batches_; ++b) {
      double& sum = batch_[layer * batches_ + b];
      to_.batch.push_back(static_cast<float>(sum / weights_));
      sum = 0;
    }
    if (!from_.shared_variance.empty()) {
      const double error = variance_[layer] / weights_;
      to_.shared_variance.push_back(static_cast<float>(error * error));
    }
    irradiance_[layer] = glm::dvec3(0.0);
    variance_[layer] = 0;
    is_lit_[layer] = 0;
  }

  const GatheredIrradiance& from_;
  GatheredIrradiance& to_;
  std::size_t batches_;
  double weights_ = 0;
  std::vector<glm::dvec3> irradiance_;  ///< per layer
  std::vector<double> batch_;           ///< [layer][batch]
  std::vector<double> variance_;        ///< per layer: of standard errors
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

GatheredIrradiance filtered_once(const GatheredIrradiance& before, const PointLinks& links,
                                 std::span<const double> layer_powers, double tolerated_errors) {
  const std::size_t lights = layer_powers.size(), points = before.points(lights);
  const std::size_t tasks = (points + filtered_per_task - 1) / filtered_per_task;
  std::vector<GatheredIrradiance::Total> total(points);
  std::vector<GatheredIrradiance> parts(tasks);
  const auto in_tasks = [&](const auto& visit) {
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
      visit(task, task * filtered_per_task, std::min(points, (task + 1) * filtered_per_task));
    });
  };
  in_tasks([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) total[i] = before.total(i, layer_powers);
  });
  in_tasks([&](std::size_t task, std::size_t first, std::size_t last) {
    WeightedPoints sums(before, lights, parts[task]);
    for (std::size_t i = first; i < last; ++i) {
      sums.add(i, 1.0);
      for (const std::uint32_t other : links.of(i)) {
        const double weight = weight_of(total[i], total[other], tolerated_errors);
        if (weight > 0) sums.add(other, weight);
      }
      sums.end_point();
    }
  });
  GatheredIrradiance after;
  after.batches = before.batches;
  if (!before.mean.first.empty()) after.mean.first.push_back(0);
  for (std::size_t i = 0; i < points; ++i) {
    after.append(parts[i / filtered_per_task], i % filtered_per_task, lights);
  }
  return after;
}

}  // namespace

GatheredIrradiance filter_irradiance(GatheredIrradiance irradiance, const PointLinks& links,
                                     std::span<const double> layer_powers,
                                     const IrradianceFilterParameters& parameters) {
  for (int round = 0; round < parameters.rounds; ++round) {
    irradiance = filtered_once(irradiance, links, layer_powers, parameters.tolerated_errors);
  }
  return irradiance;
}

}  // namespace photile
