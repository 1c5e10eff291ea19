// Final gathering: photons seen from one bounce away.
#pragma once

#include <cstdint>
#include <span>

#include "photile/estimator.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/statistics.hpp"
#include "render/map_estimators.hpp"
#include "trace/final_gather_rays.hpp"

namespace photile {

/// Estimates what primary hits get from other surfaces, in two parts (Jensen, "Realistic image
/// synthesis using photon mapping", 2001, chapter 9): caustics by the photons that brought them, at
/// the hit itself; all other light by rays to the surfaces that send it, where the photons of all
/// light are looked up. Direct light is left out.
class FinalGather {
 public:
  /// References are kept.
  ///   photons    of all light
  ///   caustics   of those that came by mirrors and glass alone; null where there are none
  FinalGather(const RayScene& rays, MapEstimators& photons, MapEstimators* caustics,
              const trace::FinalGatherParameters& parameters)
      : rays_(rays), photons_(photons), caustics_(caustics), parameters_(parameters) {}

  /// As Estimator::estimate. Takes the memory of so many ray ends at a time, or of one hit's.
  ///   number   of each hit, as in trace_final_gather
  /// Errors: as DeviceEstimators; Interrupted, when `progress` says so.
  Estimates estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                     std::int64_t ends_at_a_time, const Progress& progress);

  /// What all estimates took so far.
  struct Costs {
    TimeTaken rays_time;          ///< that tracing took
    std::uint64_t rays = 0;       ///< traced
    std::uint64_t estimated = 0;  ///< points where photons were looked up
  };
  const Costs& costs() const { return costs_; }

 private:
  Estimates gathered(const PrimaryHits& hits, const Estimates& caustics, std::size_t first,
                     std::size_t count, std::span<const std::uint64_t> number);

  const RayScene& rays_;
  MapEstimators& photons_;
  MapEstimators* caustics_;
  trace::FinalGatherParameters parameters_;
  Costs costs_;
};

}  // namespace photile
