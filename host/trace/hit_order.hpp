// The order of primary hits: by photon map, then along a Morton curve.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "trace/eye_path.hpp"

namespace photile::trace {

/// Distance along the Morton curve through a box, 21 bits an axis. Positions outside count as on
/// its border.
std::uint64_t morton_code(const glm::vec3& position, const Box& box);

/// One of the hits of several records.
struct HitPlace {
  std::uint32_t record;
  std::uint32_t index;  ///< into EyeRecord::hits
};

/// All hits in the order map, Morton code within `box`, place.
///   map_of   per sided triangle; empty where a sided triangle is the map itself
std::vector<HitPlace> sorted_places(std::span<const EyeRecord> records, const Box& box,
                                    std::span<const std::uint32_t> map_of);

}  // namespace photile::trace
