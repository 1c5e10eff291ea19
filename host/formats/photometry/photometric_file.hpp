// Photometric files of either format.
#pragma once

#include <span>
#include <string>

#include "files/warnings.hpp"
#include "photile/scene.hpp"

namespace photile::photometry {

/// Reads EULUMDAT where the file's name ends with .ldt, else LM-63.
/// Errors: ResourceError naming the file, the line, what is wrong and the remedy.
IntensityDistribution read_photometry(const std::string& name, std::span<const unsigned char> bytes,
                                      files::Warnings& warnings);

}  // namespace photile::photometry
