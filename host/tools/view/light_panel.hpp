// The parts of the panel that set lamps.
#pragma once

#include "tools/view/panels.hpp"

namespace photile::view {

/// A control for each light, or group of lights. Returns whether one has changed.
bool draw_lights(PanelState& state);

/// The moods that are kept. Returns whether one has been applied.
bool draw_moods(PanelState& state, PanelEvents& events);

}  // namespace photile::view
