// kd-trees over points, built on the host.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/device/kdtree.h"

namespace photile::maps {

/// Appends the nodes of a tree over `points[order[i]]` to `nodes` and brings `order` into the order
/// of the leaves. Leaves hold up to 8 points (more where points coincide or the depth is used up)
/// and refer to entries first_entry + position in `order`. Splits the longest side of the points'
/// box at its middle, slid to the nearest point where one side would be empty (Maneewongvatana and
/// Mount, "It's okay to be skinny, if your friends are fat", 1999).
/// `dimensions` 2 ignores z. Returns the index of the root.
std::uint32_t build_kdtree(std::span<const glm::vec3> points, std::span<std::uint32_t> order,
                           int dimensions, std::uint32_t first_entry,
                           std::vector<PhotileTreeNode>& nodes);

}  // namespace photile::maps
