// A first picture for somebody who waits: few photons, and nodes of light maps far apart.
#pragma once

#include "photile/renderer.hpp"

namespace photile {

/// What is asked of the first picture of those that these parameters ask for:
/// defaults::view_first_photons paths. Nodes that gather lie half a metre apart, and closer where
/// their light differs; otherwise estimates value the coarsest nodes alone, and direct light
/// is among them, whatever finds it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

}  // namespace photile
