// Pictures that are kept from the walkthrough.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "photile/light_mix.hpp"
#include "photile/scene.hpp"
#include "tools/view/frame.hpp"

namespace photile::view {

/// The first of STEM-0001EXTENSION, STEM-0002EXTENSION ... that is not there yet.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension);

/// sRGB texels, row 0 at the top, to PNG. Errors: OutputError.
void write_screenshot(const std::filesystem::path& file, int width, int height,
                      std::span<const std::uint8_t> rgb);

/// The frame with its layers and its camera, as `render` writes EXR. Errors: OutputError.
void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix);

}  // namespace photile::view
