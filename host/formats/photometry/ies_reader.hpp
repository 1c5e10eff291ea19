// Photometric files of the IES: ANSI/IES LM-63 from 1986 to 2019.
#pragma once

#include <string>
#include <string_view>

#include "files/warnings.hpp"
#include "photile/scene.hpp"

namespace photile::photometry {

/// Reads an LM-63 file of photometric type A, B or C. Intensities are the candela values times the
/// multiplier and the ballast factor, and in files of 1986 and 1991 times the ballast-lamp factor:
/// where the rated lumens of the lamps count, they count already, and in absolute
/// photometry (-1 lumens) there are none. Light at angles between those measured is interpolated,
/// beyond them there is none. TILT is read and ignored, with a warning if it changes anything.
/// The axes are those of the glTF extension EXT_lights_ies: vertical angle 0 of type C, or both
/// angles 0, is -z; horizontal angle 0 of type C is +x, and 90 is +y.
///   name  of the file, for messages
/// Errors: ResourceError with the line and what is wrong.
IntensityDistribution read_ies(const std::string& name, std::string_view text,
                               files::Warnings& warnings);

}  // namespace photile::photometry
