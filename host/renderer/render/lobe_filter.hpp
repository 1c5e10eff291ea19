// The filter of gloss: the noise of rays that follow lobes is averaged over pixels with similar
// surfaces and light. The light of light maps is not changed, so that textures and shadows stay
// sharp.
#pragma once

#include <span>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"

namespace photile {

/// What rays find in lobes. Runs are of samples that follow each other in a pixel's sequence.
struct LobeFilm {
  static constexpr int runs = defaults::runs_of_samples;
  static_assert(runs == 4);

  /// Twice as wide as the picture: columns 2x and 2x + 1 have the parts of pixel x that the first
  /// two runs find, and the last two.
  LightLayers halves;
  /// One layer, the light of all at their powers, `runs` times as wide as the picture.
  LightLayers mixed;
  std::vector<PixelLobes> lobes;  ///< per pixel
};

/// Adds what rays found in lobes to a picture, each pixel as a mean over pixels around it. Weights
/// come from the surfaces, and from a comparison of 3x3 pixels in relation to their noise
/// (non-local means). The weights of one half of the samples average the other half: light does not
/// influence its own weight, so that the mean of a surface is preserved (Rousselle, Knaus and
/// Zwicker, "Adaptive rendering with non-local means filtering", 2012). All layers have the same
/// weights, so that mixing stays linear.
///   powers    of the picture's layers, as in `mixed`
///   samples   of each run
void add_filtered(LightLayers& picture, const LobeFilm& film, std::span<const double> powers,
                  std::span<const int> samples);

}  // namespace photile
