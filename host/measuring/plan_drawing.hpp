// A plane of sensors as a false-colour drawing.
#pragma once

#include <string>

#include "measuring/false_colour.hpp"
#include "measuring/measurement.hpp"

namespace photile::measuring {

/// SVG of a plane seen against the direction that it faces, `u` to the right: cells in the colours
/// of their values, isolines with their values, a legend and a scale in metres; with few cells also
/// each one's value. `light` is one of values.lights. Needs values.grid.layout.
std::string plan_svg(const GridValues& values, const LightValues& light,
                     const FalseColour& options);

}  // namespace photile::measuring
