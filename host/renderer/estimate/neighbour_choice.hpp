// A separate number of neighbours for each hit: that for which the error of its estimate is least.
#pragma once

#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"

namespace photile::estimate {

/// The k that hits choose from: `most`, and quarters of it down to `least`. Ascending.
std::vector<int> neighbour_levels(int least, int most);

/// The last level whose estimate differs from that of no level before it by more than photons'
/// noise explains (Lepski 1991): with more neighbours noise falls, and what is left of the
/// difference is bias.
///   values       estimate per level, ascending k
///   neighbours   k of the levels
std::size_t least_error_level(std::span<const double> values, std::span<const int> neighbours);

/// Per hit the estimates of one level, the same for all lights, so that the picture stays linear in
/// their powers. The choice looks at the luminance of all lights together.
///   levels       the same hits by neighbours[level], ascending k
///   weights      per light: its power when the choice is made
LightTable estimates_of_least_error(std::vector<LightTable> levels, std::span<const int> neighbours,
                                    std::span<const double> weights);

/// The powers of a scene's layers; all 1 where every light is off.
std::vector<double> layer_powers(const Scene& scene);

}  // namespace photile::estimate
