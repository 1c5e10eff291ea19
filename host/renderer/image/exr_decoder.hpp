// An EXR as one picture.
#pragma once

#include <memory>

#include "image/decoder.hpp"

namespace photile::image {

/// Its first part. Errors: DecodeError.
std::unique_ptr<Decoder> open_exr(Encoded bytes);

}  // namespace photile::image
