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

/// Of trace_primary_hits, with the same samples, what comes by a mirror, by glass that bends or
/// reflects it, or by a glossy lobe: hits behind those as they are, hits that are seen directly (or
/// through panes of thin glass) with their lobe alone, and lamps in neither case. Added to what is
/// left out it is the whole.
PrimaryHitBatch trace_reflected_hits(const RayScene& scene, const Camera& camera,
                                     const PrimaryHitParameters& parameters, int first_row,
                                     int last_row, std::span<const std::uint32_t> map_of = {});

}  // namespace photile::trace
