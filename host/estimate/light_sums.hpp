// How the kernels keep the sums of a hit: kernels/estimate/sums.clh.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/context.hpp"
#include "photile/scene_needs.hpp"

namespace photile::estimate {

/// Estimates that a hit has room for: one per light, or with many lights min(k, lights) slots.
std::uint32_t estimates_per_hit(const SceneNeeds& needs, std::uint32_t neighbours);

/// The symbols of sums.clh.
void set_sum_defines(device::Defines& defines, const SceneNeeds& needs, std::uint32_t neighbours);

/// Of the arrays that a work-item keeps in private memory for its sums.
std::size_t private_sum_bytes(const SceneNeeds& needs, std::uint32_t neighbours);

}  // namespace photile::estimate
