// The noise of a pixel's samples, told from runs of them.
#pragma once

#include "photile/light_layers.hpp"

namespace photile {

/// Adds, in squares, the standard error of the samples of each pixel, by light, to that of what
/// they see. It is told from the scatter of runs of samples that follow each other in a pixel's
/// sequence. The variance of well-spread samples falls as N^-1 where they are noise, as N^-3/2 at
/// an edge and as N^-2 where light changes evenly (Mitchell, "Consequences of stratified sampling
/// in graphics", 1996). Here it is that of an edge: of R runs, that of independent ones over
/// sqrt(R).
///   errors   of the picture
///   runs     as many times as wide as there are runs: column x * count + run has the sum of that
///            run of samples of pixel x
void add_sample_errors(LightLayers& errors, const LightLayers& runs);

}  // namespace photile
