// Settings derived from others: for more or less work, and for a first picture.
#pragma once

#include "photile/renderer.hpp"

namespace photile {

/// Multiplies by `factor` the settings that the quality `final` has more of than `good` (photons,
/// samples of a pixel, rays of nodes), each within its range.
RenderParameters with_work(RenderParameters parameters, double factor);
/// The largest factor that all of these settings may be multiplied by.
int most_work(const RenderParameters& parameters);

/// The settings of the first picture in a sequence that ends with these parameters:
/// defaults::view_first_photons paths. Nodes that gather lie half a metre apart, and closer where
/// their light differs; otherwise estimates fill the coarsest nodes alone, and include direct
/// light, whatever finds it later.
RenderParameters first_picture_parameters(const RenderParameters& asked);

}  // namespace photile
