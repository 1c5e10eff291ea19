// Light layers in the channels of a picture, whichever program wrote it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "image/light_records.hpp"
#include "photile/image.hpp"

namespace photile::image {

/// Where one light's layer lies among the channels of a picture.
struct LayerChannels {
  std::array<std::size_t, 3> rgb;
  std::optional<std::size_t> illuminance;
};

struct LayerSet {
  LightRecords records;                 ///< every layer's light, in the order of the sum
  std::vector<LayerChannels> channels;  ///< one per light
};

/// Finds `Combined_<light>.R/G/B` (photile), the same behind a view layer's name (Blender) and
/// `RGBA_<light>.R/G/B` (Arnold), with `Illuminance_<light>.Y`. The order is that of
/// `photile.lights`; lights without a record follow as they stand in the file, with power 1.
/// Errors: InputError when there is no layer, one lacks a channel, or there are several views.
LayerSet find_layers(const PictureHeader& image);

}  // namespace photile::image
