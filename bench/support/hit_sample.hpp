// Some of a workload's hits.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/ray_scene.hpp"

namespace photile::bench {

struct HitSample {
  PrimaryHits hits;
  std::vector<std::uint32_t> index;  ///< of each in the whole, ascending
};

/// The hits of the given indices. Surfaces must be diffuse.
HitSample hits_at(const PrimaryHits& hits, std::vector<std::uint32_t> index);

/// Every `stride`-th block of 256 successive hits, so that neighbours stay neighbours; all hits
/// where `stride` is 1. A sample contains those of every multiple of its stride.
HitSample block_sample(const PrimaryHits& hits, std::size_t stride);

/// Every n-th hit of a sample, so that at most `requested` are left.
HitSample thinned(const HitSample& sample, std::size_t requested);

}  // namespace photile::bench
