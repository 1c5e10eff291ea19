// The part of the panels that sets lamps.
#pragma once

#include "view/light_board.hpp"

namespace photile::view {

/// A switch, a solo switch, a colour, a power and a temperature for each light. True where one of
/// them was changed.
bool draw_lights(LightBoard& board);

}  // namespace photile::view
