// Rays from primary hits to the surfaces whose light they reflect: the final gather of photon
// mapping (Jensen, "Global illumination using photon maps", 1996).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "trace/receiver.hpp"

namespace photile::trace {

struct FinalGatherParameters {
  int rays;  ///< from each primary hit
  std::uint64_t seed;
  int max_specular_depth;  ///< mirrors and glass that a ray follows
};

/// Rays from a run of primary hits that end on an opaque surface, in the order primary hit, ray.
struct FinalGatherRays {
  /// Rays of the run's primary hit i are [first[i], first[i + 1]).
  std::vector<std::size_t> first;
  /// Of each ray: what radiance from its end counts at the primary hit. Summed over a hit's rays,
  /// weight x radiance is an unbiased estimate of what other surfaces send there straight or over
  /// mirrors and glass.
  std::vector<LightWeights> weight;
  std::vector<std::uint32_t> end;  ///< of each ray, into `ends`
  PrimaryHits ends;                ///< in the order that PrimaryHits asks for; pixels mean nothing
  std::uint64_t traced = 0;        ///< those along mirrors and glass included
};

/// Traces rays in directions of the surfaces' own reflection, spread evenly over each hit's rays,
/// through holes, mirrors and glass to the next opaque surface. Lamps are not seen: their light is
/// direct light, or a caustic. Depends on the scene, the hits, their numbers and the parameters
/// only.
///   number   of each hit, below 2^48: the same number and hit give the same rays
///   map_of   as in trace_primary_hits
FinalGatherRays trace_final_gather(const RayScene& rays, const PrimaryHits& hits, std::size_t first,
                                   std::size_t count, std::span<const std::uint64_t> number,
                                   const FinalGatherParameters& parameters,
                                   std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
