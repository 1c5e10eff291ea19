// What a screen shows: the sRGB transfer curve, exact in both pieces (IEC 61966-2-1), tone-mapped
// texels, and PNG files.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/files.hpp"
#include "photile/image.hpp"

namespace photile::image {

/// The numbers of the display transform of `tone_map`, which the pages of `photile publish` are
/// given, too (publish/page/display.js). Those of DisplayView::neutral have the specification's
/// names.
struct DisplayTransform {
  /// What the log-average luminance becomes: the key of bright rooms, twice a photographer's grey
  /// card (Reinhard et al. have 0.18 for most pictures and up to 0.72 for light ones). Walls and
  /// ceilings reflect more than half, and the neutral view takes 0.04 off all.
  double key = 0.36;
  /// Luminances farther than this factor from the median say nothing about the room: a light seen
  /// directly, a dark corner. Only so large a share of the picture is taken for lights.
  double outlier_factor = 20, light_share = 0.1;
  /// What is darker than the brightest pixels of that share by this factor is black: nothing, or
  /// faces that next to no light reaches.
  double black_factor = 1000;
  /// Multiples of white that only the same share of what is no light may exceed, as at night walls
  /// near a lamp do: from there on the neutral view shows no shape.
  double highlights = 2.5;
  double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
  /// Multiples of white from which on something beside a pixel is a lamp or a window, whose border
  /// is mixed as it is displayed: highlights are seldom as bright.
  double least_of_light = 4;
};
inline constexpr DisplayTransform display_transform;

double srgb_from_linear(double linear);   ///< [0,1] to [0,1]
double linear_from_srgb(double encoded);  ///< [0,1] to [0,1]

/// Nearest 8-bit code value of a linear value; NaN and negative values give 0, more than 1 gives
/// 255.
std::uint8_t srgb8_from_linear(float linear);

/// 8-bit texels of display-referred R, G, B, which the picture must have: 3 bytes a pixel, row 0 at
/// the top. Shared among all cores.
std::vector<std::uint8_t> srgb8_texels(const Image& display_referred);

/// The bytes of a PNG of rows x width x channels texels (3: RGB, 4: RGB and an alpha that colours
/// are not multiplied with). Errors: those of OutputFile::fail.
///   output   the file that they are for
std::vector<std::uint8_t> png_bytes(const OutputFile& output, int width, int height,
                                    std::span<const std::uint8_t> texels);

/// Writes them to a file that the caller commits.
void encode_png(OutputFile& output, int width, int height, std::span<const std::uint8_t> texels);

}  // namespace photile::image
