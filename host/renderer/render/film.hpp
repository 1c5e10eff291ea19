// The film: estimates of primary hits are added to the pixels that see them, those of many lights
// mixed to those of few, and the noise of a pixel's samples is estimated from runs of them.
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
///   sample_weight   1 / samples per pixel: what a whole sample counts in the illuminance of its
///   pixel
void add_to_film(LightLayers& layers, const PrimaryHitBatch& batch, const LightTable& estimates,
                 float sample_weight);

/// Raises to zero what is below it in a finished picture.
void raise_to_zero(LightLayers& layers);

/// Adds, in squares, the standard error of the samples of each pixel, by light, to that of what
/// they see. It is estimated from the scatter of runs of samples that follow each other in a
/// pixel's sequence. The variance of well-spread samples falls as N^-1 where they are noise, as
/// N^-3/2 at an edge and as N^-2 where light changes evenly (Mitchell, "Consequences of stratified
/// sampling in graphics", 1996). Here it is that of an edge: of R runs, that of independent ones
/// over sqrt(R).
///   errors   of the picture
///   runs     as many times as wide as there are runs: column x * count + run has the sum of that
///            run of samples of pixel x
void add_sample_errors(LightLayers& errors, const LightLayers& runs);

/// The sum of the layers at these powers, row by row.
std::vector<glm::vec3> mixed(const LightLayers& layers, std::span<const double> powers);

/// Pixels of another film, and what each counts in those of a row: entries first[x] to first[x + 1]
/// are of pixel x.
struct RowWeights {
  std::vector<std::uint32_t> first{0};
  std::vector<std::uint32_t> pixel;
  std::vector<float> weight;
};

/// Adds the radiance of pixels of `from` to a row of the layers.
void add_weighted(LightLayers& layers, int row, const LightLayers& from, const RowWeights& weights);

/// The light of the pooled layers; the lights of a row are summed in its own order.
LightTable pooled(const LayerMixdown& mixdown, const LightTable& light);

/// Pools the emission of visible lights.
void pool_emission(const LayerMixdown& mixdown, PrimaryHitBatch& batch);

}  // namespace photile
