// Light layers in the channels of a picture, whichever program wrote it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "photile/image.hpp"
#include "photile/layered_picture.hpp"

namespace photile::image {

/// Lights as a picture records them.
struct LightRecords {
  LightMix mix;  ///< in the order of the sum
  /// Lights whose power is a multiple of an unknown one (pictures of other programs): recorded
  /// without a unit, so that it stays unknown however often the picture is relit.
  std::set<std::string> relative;
};

/// Sets `photile.lights`, `photile.units`, `photile.illuminance.units` and `photile.efficacy`, and
/// `whiteLuminance` (cd/m2 of RGB (1,1,1)). Units are left out where some power is relative.
void write_light_records(PictureHeader& image, const LightRecords& records);

/// The records of a picture; none gives an empty mix. Errors: InputError for damaged ones.
LightRecords read_light_records(const PictureHeader& image);

/// The position of one light's layer among the channels of a picture.
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
