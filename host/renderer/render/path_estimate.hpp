// The path tracer's answer to the question that photon maps answer with a density: irradiance and
// reflected radiance at points of opaque surfaces. Unbiased, noisy, and without any of their code.
#pragma once

#include <cstdint>
#include <span>

#include "photile/estimator.hpp"
#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"

namespace photile::reference {

class PathEstimator {
 public:
  /// References are kept. Errors: InputError for an area light without area.
  PathEstimator(const RayScene& rays, std::uint64_t seed);

  /// One path from each hit; work is shared by TBB. Depends on the hits and the numbers alone.
  ///   number   of each hit's path, below 2^48: the same number and hit give the same path
  /// Errors: Interrupted, when `progress` says so.
  Estimates estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                     const Progress& progress = Progress::none()) const;

 private:
  const RayScene& rays_;
  std::uint64_t seed_;
  SceneNeeds needs_;
  trace::LightSampler lights_;
};

}  // namespace photile::reference
