// Palettes that are linear between a few colours.
#pragma once

#include <glm/glm.hpp>
#include <string>

namespace photile::image {

/// Linear RGB in [0, 1] of a share in [0, 1] of "turbo", "viridis", "inferno", "magma", "plasma",
/// "heat", "spectrum" or "blue-red".
glm::dvec3 knot_colour(const std::string& name, double share);

}  // namespace photile::image
