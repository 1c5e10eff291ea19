// The attributes through which a picture knows its lights: `photile.lights` and the units.
#pragma once

#include <set>
#include <string>

#include "photile/image.hpp"
#include "photile/light_mix.hpp"

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

}  // namespace photile::image
