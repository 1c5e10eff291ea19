// Settings that belong together, by name.
#pragma once

#include <array>
#include <cstddef>
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

/// Its place in all_qualities.
constexpr std::size_t index_of(Quality quality) { return static_cast<std::size_t>(quality); }

/// What its pictures are like.
std::string_view description_of(Quality quality);

/// Sets what the table of settings (render/setting.hpp) has for the quality, and leaves all others.
void set_quality(RenderParameters& parameters, Quality quality);

}  // namespace photile
