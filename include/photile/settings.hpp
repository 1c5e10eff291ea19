// The settings of a rendering, all at once by the quality wanted, or each by its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

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

/// Sets what the table of settings (docs/settings.md) has for the quality, and leaves all others.
void set_quality(RenderParameters& parameters, Quality quality);

/// Names of all settings, such as "photons_emitted", in the order of the table.
std::vector<std::string_view> setting_names();

/// Sets one by its name: for programs whose users name settings. Whole numbers serve where any
/// number does. Errors: UsageError, one line that begins with the name, for an unknown name or a
/// value out of the range of the table.
void set_by_name(RenderParameters& parameters, std::string_view name,
                 const std::variant<std::uint64_t, double, std::string_view>& value);

}  // namespace photile
