// The camera of a picture, written where compositing tools look for it.
#pragma once

#include "photile/camera.hpp"
#include "photile/image.hpp"

namespace photile {

/// Sets the matrices `worldToCamera` and `worldToNDC` as OpenEXR's standard attributes define them,
/// for a film of width x height pixels. Row vectors: p' = p M. Camera space is left-handed, +x
/// right, +y up, +z along the view, in metres. NDC, after division by w, is [0,1] x [0,1] over the
/// picture with (0,0) in its upper left corner; its z is 1 / depth and only keeps the matrix
/// invertible.
void set_camera_attributes(PictureHeader& image, const Camera& camera, int width, int height);

}  // namespace photile
