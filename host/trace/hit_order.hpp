// The order of primary hits: by sided triangle, then along a Morton curve.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "trace/eye_path.hpp"

namespace photile::trace {

/// Distance along the Morton curve through a box, 21 bits an axis. Positions outside count as on
/// its border.
std::uint64_t morton_code(const glm::vec3& position, const Box& box);

/// Indices of the hits in the order sided triangle, Morton code within `box`, index.
std::vector<std::uint32_t> sorted_order(const std::vector<EyeHit>& hits, const Box& box);

}  // namespace photile::trace
