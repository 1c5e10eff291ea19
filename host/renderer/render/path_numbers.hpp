// Numbers of the samples that hits come from.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/ray_scene.hpp"

namespace photile {

/// A number of its own for each hit of a batch of rows: pixel x samples + sample, below 2^48. Does
/// not depend on how the picture is split into batches, for the order of a pixel's own hits does
/// not.
std::vector<std::uint64_t> path_numbers(const PrimaryHits& hits, const PrimaryHitParameters& film,
                                        int first_row, int last_row);

}  // namespace photile
