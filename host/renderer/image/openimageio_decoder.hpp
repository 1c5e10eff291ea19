// OpenImageIO's readers, in a module of its own: it brings some 260 shared libraries.
#pragma once

#include "image/decoder.hpp"

extern "C" {

/// Opens a picture of any format but EXR, which `bytes` must outlive; the caller deletes it.
/// Errors: DecodeError.
__attribute__((visibility("default"))) photile::image::Decoder* photile_openimageio_decoder(
    photile::image::PictureFormat format, photile::image::Encoded bytes);

}  // extern "C"
