// The colours of palettes: OpenImageIO's and matplotlib's by knots, those of Radiance's falsecolor.
#pragma once

#include <glm/glm.hpp>
#include <string>

namespace photile::report {

/// Linear RGB in [0, 1] of a share in [0, 1] of "turbo", "viridis", "inferno", "magma", "plasma",
/// "heat", "spectrum" or "blue-red".
glm::dvec3 knot_colour(const std::string& name, double share);

/// "def", "spec", "pm3d", "hot" or "eco". ("tbo" is OpenImageIO's turbo.)
bool is_radiance_palette(const std::string& name);

/// Linear RGB in [0, 1] of a share in [0, 1], as falsecolor.pl of Radiance 5 has it.
glm::dvec3 radiance_palette(const std::string& name, double share);

}  // namespace photile::report
