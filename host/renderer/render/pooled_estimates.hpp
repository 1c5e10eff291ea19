// Estimates of many lights, mixed to those of few before they are added to a film.
#pragma once

#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// The estimates of the pooled layers; those of a hit are summed in its own order.
Estimates pooled(const LightPooling& pooling, const Estimates& estimates, std::size_t hits);

/// Pools the emission of visible lights.
void pool_emission(const LightPooling& pooling, PrimaryHitBatch& batch);

}  // namespace photile
