// A first picture for somebody who waits: few photons, kept at the coarsest nodes of light maps.
#pragma once

#include "photile/renderer.hpp"

namespace photile {

/// What is asked of the first picture of those that these parameters ask for:
/// defaults::view_first_photons paths, whose estimates value the coarsest nodes. Light straight
/// from lamps is among them, whatever brings it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

}  // namespace photile
