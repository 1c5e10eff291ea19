// EULUMDAT, the photometric files of Europe (.ldt).
#pragma once

#include <string>
#include <string_view>

#include "files/warnings.hpp"
#include "photile/scene.hpp"

namespace photile::photometry {

/// Reads an EULUMDAT file (Stockmar 1990). Intensities, in cd per 1000 lm, are multiplied by the
/// flux of the first set of lamps and by the file's conversion factor. Decimal commas count as
/// points. C0 is +x and C90 is +y of the lamp, gamma 0 is -z.
///   name  of the file, for messages
/// Errors: ResourceError with the line and what is wrong.
IntensityDistribution read_eulumdat(const std::string& name, std::string_view text,
                                    files::Warnings& warnings);

}  // namespace photile::photometry
