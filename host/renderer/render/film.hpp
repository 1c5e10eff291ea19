// The film: estimates of primary hits are added to their pixels, layers of many lights are mixed
// down to few, and the noise of a pixel's samples is estimated from runs of them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// Adds a batch to the layers. Each pixel's sums run in the order of the hits, so the picture does
/// not depend on the number of threads. For layers of many lights it takes 16 bytes per light and
/// thread.
///   sample_weight   1 / samples per pixel: the weight of a whole sample in the illuminance of
///                   its pixel
void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const LightTable& estimates,
                 float sample_weight);

/// Sets negative values of a finished picture to zero.
void raise_to_zero(LightLayers& layers);

/// Adds in quadrature, by light, the standard error of each pixel's samples to that of the light
/// that they measure. It is estimated from the scatter of runs of samples that follow each other in
/// a pixel's sequence. The variance of well-spread samples falls as N^-1 where they are noise, as
/// N^-3/2 at an edge and as N^-2 where light changes evenly (Mitchell, "Consequences of stratified
/// sampling in graphics", 1996). Here the rate of an edge is assumed: for R runs, the variance of
/// independent ones over sqrt(R).
///   errors   of the picture
///   runs     as many times as wide as there are runs: column x * count + run has the sum of that
///            run of samples of pixel x
void add_sample_errors(LightLayers& errors, const LightLayers& runs);

/// The sum of the layers at these powers, row by row.
std::vector<glm::vec3> mixed(const LightLayers& layers, std::span<const double> powers);

/// Pixels of another film, and their weights in the pixels of a row: entries first[x] to first[x +
/// 1] are of pixel x.
struct RowWeights {
  std::vector<std::uint32_t> first{0};
  std::vector<std::uint32_t> pixel;
  std::vector<float> weight;
};

/// Adds the radiance of pixels of `from` to a row of the layers.
void add_weighted(LightLayers& layers, int row, const LightLayers& from, const RowWeights& weights);

/// The light of the mixed layers; the lights of a row are summed in its own order.
LightTable pooled(const LayerMixdown& mixdown, const LightTable& light);

/// Mixes down the emission of visible lights.
void pool_emission(const LayerMixdown& mixdown, PrimaryHitBatch& batch);

}  // namespace photile
