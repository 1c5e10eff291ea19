// The light of a run of points that gather, added up from the ends of their rays and from light
// samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cache/irradiance_gather.hpp"
#include "cache/ray_ends.hpp"

namespace photile::cache {

/// The data that the sums of a run of points are made from.
struct RunLight {
  const RayScene& rays;
  const trace::LightSampler& light_sampler;
  const IrradianceGatherParameters& parameters;
  int rays_per_batch, light_samples_per_batch;
  int most_light_samples_per_batch;  ///< where light is uncertain
  std::uint32_t first_light_sample;  ///< of a batch
  const PrimaryHits& points;
  std::span<const std::uint64_t> number;
  const RayEnds* traced;       ///< null where no rays are
  const LightTable& of_ends;   ///< of the nodes that rays read where they end
  const LightTable& caustics;  ///< of all points; empty where there are none
  double caustic_relative_variance;
  std::span<const double> layer_powers;
};

/// The light of points, in parts that tasks wrote, in the order of the points.
struct GatheredRuns {
  std::vector<LightTable> indirect, direct;
  std::vector<float> distance;  ///< per point
};

/// Appends the light of the points of a run.
void add_sums(const RunLight& run, std::size_t first, std::size_t count, GatheredRuns& sums);

}  // namespace photile::cache
