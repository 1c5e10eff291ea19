// Settings that belong together, by name.
#pragma once

#include <array>
#include <string_view>

#include "photile/renderer.hpp"

namespace photile {

enum class Quality {
  draft,  ///< the photon estimate at each hit: quick, mottled
  good,   ///< light maps whose nodes gather: clean to the eye
  best    ///< the same with four times the rays, photons and samples
};

/// "draft", "good", "final".
std::string_view name_of(Quality quality);
inline constexpr std::array all_qualities = {Quality::draft, Quality::good, Quality::best};

/// Sets what the quality is made of and leaves all other settings: photons, neighbours, samples of
/// a pixel, light maps and the rays of their nodes.
void set_quality(RenderParameters& parameters, Quality quality);

}  // namespace photile
