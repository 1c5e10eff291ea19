// Settings made from others: more or less of all work, and those of a first picture.
#pragma once

#include "photile/renderer.hpp"

namespace photile {

/// The settings that the quality `final` has more of than `good` (photons, samples of a pixel, rays
/// of nodes) times `factor`, each within its range.
RenderParameters with_work(RenderParameters parameters, double factor);
/// The largest factor that all of these settings may be multiplied by.
int most_work(const RenderParameters& parameters);

/// The settings of the first picture in a sequence that ends with these parameters:
/// defaults::view_first_photons paths. Nodes that gather lie half a metre apart, and closer where
/// their light differs; otherwise estimates value the coarsest nodes alone, and direct light is
/// among them, whatever finds it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

}  // namespace photile
