// The noise of a pixel's samples, told from runs of them.
#pragma once

#include "photile/light_layers.hpp"

namespace photile {

/// Adds, in squares, the standard error of the samples of each pixel, by light, to that of what
/// they see. Runs of samples that follow each other in a pixel's sequence are spread over the pixel
/// and its lobes much as all are: the scatter of their sums is taken for that of independent ones,
/// which is a little more than what is left.
///   errors   of the picture
///   runs     as many times as wide as there are runs: column x * count + run has the sum of that
///            run of samples of pixel x
void add_sample_errors(LightLayers& errors, const LightLayers& runs);

}  // namespace photile
