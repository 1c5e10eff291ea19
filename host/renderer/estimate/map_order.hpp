// The order in which hits are estimated, and selections of hits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/ray_scene.hpp"

namespace photile::estimate {

/// Numbers of hits in ascending order of their maps, and on each map along a Morton curve: what
/// kernels read for one hit is near what they read for the next. Empty where hits are in the order
/// of their maps already.
///   maps, position   of the hits
std::vector<std::uint32_t> order_by_map(std::span<const std::uint32_t> maps,
                                        std::span<const glm::vec3> position);

/// Hit i of the result is hit order[i]. Pixels and throughput, which no estimate reads, are left
/// out.
PrimaryHits reordered(const PrimaryHits& hits, std::span<const std::uint32_t> order);

}  // namespace photile::estimate
