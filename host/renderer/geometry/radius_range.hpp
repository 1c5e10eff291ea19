// The search radii for which the arithmetic holds.
#pragma once

#include "photile/scene.hpp"

namespace photile {

/// Metres between opposite corners of the box around the scene: the largest distance in it.
double scene_diagonal(const Scene& scene);

/// The smallest radius, metres, that check_radius takes.
double least_radius(const Scene& scene);

/// Errors: UsageError, with the remedy, where `radius`, metres, is not a number in the range of
/// limits.hpp.
void check_radius(const Scene& scene, double radius);

}  // namespace photile
