// What a camera sees by reflection alone.
#pragma once

#include <cstdint>
#include <span>

#include "photile/primary_hits.hpp"

namespace photile::trace {

/// Of trace_primary_hits, with the same samples, what comes by a mirror, by glass that bends or
/// reflects it, or by a glossy lobe: hits behind those as they are, hits that are seen directly (or
/// through panes of thin glass) with their lobe alone, and lamps in neither case. Added to what is
/// left out it is the whole.
PrimaryHitBatch trace_reflected_hits(const RayScene& scene, const Camera& camera,
                                     const PrimaryHitParameters& parameters, int first_row,
                                     int last_row, std::span<const std::uint32_t> map_of = {});

}  // namespace photile::trace
