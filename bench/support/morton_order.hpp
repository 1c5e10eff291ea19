// Orders of queries.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photile::bench {

/// Indices of the positions along the Morton curve through their bounding box, 10 bits an axis.
std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> positions);

}  // namespace photile::bench
