// Pictures of illuminance and luminance in false colour.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photile/layered_picture.hpp"
#include "report/false_colour.hpp"

namespace photile::report {

/// Illuminance of the surface that each pixel sees, by all lights together: lux, row 0 at the top.
/// Errors: InputError naming a light whose illuminance is not known; those of `read`.
std::vector<float> illuminance_of(const LayeredPicture& picture);

/// Luminance of each pixel, cd/m2, row 0 at the top. Errors: InputError where the picture does not
/// say how many cd/m2 its values are (the attribute `whiteLuminance`), or has no R, G, B.
std::vector<float> luminance_of(const Image& picture);

/// Puts values into their colours; of isolines and bands only pixels that lie on one, over what
/// `rgb` shows.
///   values   of each pixel, rows of `width`
///   rgb      8-bit sRGB, 3 bytes a pixel
/// Errors: UsageError for an unknown palette.
void draw_false_colour(std::span<const float> values, int width, const FalseColour& options,
                       std::span<std::uint8_t> rgb);

/// Values in their colours, at the top left, and beside them a legend; display-referred, as
/// write_png takes it. Letters are drawn where the font DejaVu Sans is installed.
///   displayed   what isolines and bands lie over: display-referred R, G, B of as many pixels
/// Errors: as above.
Image false_colour_picture(std::span<const float> values, const Image& displayed,
                           const FalseColour& options);

}  // namespace photile::report
