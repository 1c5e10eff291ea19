#include "gather/irradiance_filter.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gather/weighted_points.hpp"

namespace photile {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t filtered_per_task = 256;

GatheredIrradiance filtered_once(const GatheredIrradiance& before, const PointLinks& links,
                                 std::span<const double> layer_powers,
                                 const NoiseTolerance& tolerated) {
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
    gathering::WeightedPoints sums(lights, before, parts[task]);
    for (std::size_t i = first; i < last; ++i) {
      sums.add(before, i, 1.0);
      for (const std::uint32_t other : links.of(i)) {
        const double weight = likeness(total[i], total[other], tolerated);
        if (weight > 0) sums.add(before, other, weight);
      }
      sums.end_point();
    }
  });
  GatheredIrradiance after;
  after.batches = before.batches;
  if (!before.mean.first.empty()) after.mean.first.push_back(0);
  for (GatheredIrradiance& part : parts) after.append(std::move(part));
  return after;
}

}  // namespace

double likeness(const GatheredIrradiance::Total& a, const GatheredIrradiance::Total& b,
                const NoiseTolerance& tolerated) {
  const double difference = a.luminance - b.luminance;
  if (difference == 0) return 1;
  const double variance = a.error * a.error + b.error * b.error;
  const double like =
      std::exp(-difference * difference / (tolerated.errors * tolerated.errors * variance));
  const auto [calm, noisy] = a.error < b.error ? std::pair(a, b) : std::pair(b, a);
  if (!(tolerated.ratio * calm.error < noisy.error)) return like;
  if (!(calm.error < tolerated.known * calm.luminance)) return like;
  const double part = tolerated.ratio * calm.error / noisy.error;
  return like * part * part;
}

GatheredIrradiance filter_irradiance(GatheredIrradiance irradiance, const PointLinks& links,
                                     std::span<const double> layer_powers,
                                     const IrradianceFilterParameters& parameters) {
  for (int round = 0; round < parameters.rounds; ++round) {
    irradiance = filtered_once(irradiance, links, layer_powers, parameters.tolerated);
  }
  return irradiance;
}

}  // namespace photile
