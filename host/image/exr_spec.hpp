// The headers of the EXRs that photile writes.
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

#include "photile/image.hpp"

namespace photile::image {

/// A part of 32-bit floats with the header's size and the given channels. Says what its colours
/// are, as every part of a file must, and nothing else.
OIIO::ImageSpec exr_spec(const PictureHeader& header, const std::vector<std::string>& channels,
                         const char* compression);

/// Adds the header's attributes.
void add_attributes(const PictureHeader& header, OIIO::ImageSpec& spec);

}  // namespace photile::image
