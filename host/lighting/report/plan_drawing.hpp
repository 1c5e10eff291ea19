// A plane of sensors as a false-colour drawing.
#pragma once

#include <string>

#include "measuring/measurement.hpp"
#include "report/false_colour.hpp"
#include "report/plan_lines.hpp"

namespace photile::report {

enum class PlanSize {
  whole,  ///< with the values of isolines and, where they are few, of cells; and the plane's name
  small   ///< one of several: called as its light, without values but for the legend's
};

/// SVG of a plane seen against the direction that it faces, `u` to the right: cells in the colours
/// of their values, isolines at the steps of EN 12464-1, a legend, a scale in metres, coordinates
/// of two corners, and what surrounds the plane. A whole one has a scale, such as 1:50, at which it
/// fits on a page of A4, and the metres of the plane and of the room. `light` is one of
/// values.lights. Needs values.grid.layout.
std::string plan_svg(const measuring::GridValues& values, const measuring::LightValues& light,
                     const FalseColour& options, PlanSize size = PlanSize::whole,
                     const PlanSurroundings& surroundings = {});

}  // namespace photile::report
