// What runs of samples saw, as one batch of hits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/primary_hits.hpp"
#include "photile/ray_scene.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_order.hpp"

namespace photile::trace {

/// The hits at these places of the records, in the order of the places.
PrimaryHits hits_at(std::span<const EyeRecord> records, std::span<const HitPlace> places);

/// The hits of all rows in the order that PrimaryHits asks for, and the emission by layer in place
/// of light. Does not depend on how samples are split into rows.
///   map_of   as in trace_primary_hits
PrimaryHitBatch batch_of(const RayScene& rays, std::vector<EyeRecord> rows,
                         std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
