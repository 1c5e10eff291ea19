// The light that pictures of one scene show as white, kept with them as the attribute
// `photile.white`: a lamp that is made warmer looks warmer, since the white stays.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"

namespace photile::image {

/// Linear Rec.709 at luminance 1, no primary below a twentieth, so that dividing by it leaves noise
/// in bounds.
using White = std::array<float, 3>;

/// The white of the light of all lamps together: their colours, weighted by the light of each. {1,
/// 1, 1} where nothing is lit.
///   illuminance   of each light, summed over the surfaces that are seen
White white_of_light(std::span<const double> illuminance, const LightMix& mix);

/// The white of rendered layers, by the illuminance of the surfaces that they show.
///   mix   the lamps as the scene has them
White white_of(const LightLayers& layers, const LightMix& mix);

/// That which is kept with the picture; else that of its lights as they are, by their illuminance,
/// or by their luminance where the picture has none. Errors: those of kept_white.
White white_of(const LayeredPicture& picture);

/// The white of a colour temperature, kelvin.
White white_of_temperature(double kelvin);

/// That which is kept with a picture, or none. Errors: InputError where the attribute is damaged.
std::optional<White> kept_white(const PictureHeader& picture);
void keep_white(PictureHeader& picture, const White& white);

}  // namespace photile::image
