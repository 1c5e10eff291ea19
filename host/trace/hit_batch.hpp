// What runs of samples saw, as one batch of hits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "trace/eye_path.hpp"

namespace photile::trace {

/// Hits as PrimaryHits has them.
///   order   of the result: indices into `hits`
///   glossy  whether they know their lobes
PrimaryHits in_order(const std::vector<EyeHit>& hits, const std::vector<std::uint32_t>& order,
                     bool glossy);

/// The hits of all rows in the order that PrimaryHits asks for, and the emission by layer in place
/// of light. Does not depend on how samples are split into rows.
///   map_of   as in trace_primary_hits
PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows,
                         std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
