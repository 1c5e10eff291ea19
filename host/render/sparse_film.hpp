// Adds the estimates of primary hits to sparse layers.
#pragma once

#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/primary_hits.hpp"

namespace photile {

/// As add_to_film, for layers and estimates of many lights. Work is shared by rows; memory beside
/// the layers is 16 bytes per light and thread.
void add_to_sparse_film(LightLayers& layers, const PrimaryHitBatch& batch,
                        const Estimates& estimates, float sample_weight);

}  // namespace photile
