// Adds the estimates of primary hits to the pixels that see them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// Adds a batch to the layers. Each pixel's sums run in the order of the hits, so the picture does
/// not depend on the number of threads. For layers of many lights it takes 16 bytes per light and
/// thread.
///   sample_weight   1 / samples per pixel: what a whole sample counts in the illuminance of its
///   pixel
void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const Estimates& estimates,
                 float sample_weight);

/// Raises to zero what is below it in a finished picture.
void raise_to_zero(LightLayers& layers);

}  // namespace photile
