// The camera of a picture, written where compositing tools look for it.
#pragma once

#include <string>

#include "photile/camera.hpp"
#include "photile/image.hpp"

namespace photile {

/// The view as Radiance's pictures tell it ("-vta -vp 0 0 1.2 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv
/// 180"), for a film of width x height pixels. Empty where Radiance has no such view: a whole
/// sphere, or a fisheye whose picture is wider than its hemisphere.
std::string radiance_view(const Camera& camera, int width, int height);

/// Sets the attribute `photile.view`, as radiance_view has it, and the matrices `worldToCamera`
/// and, of a perspective, `worldToNDC` as OpenEXR's standard attributes define them, for a film of
/// width x height pixels. Row vectors: p' = p M. Camera space is left-handed, +x
/// right, +y up, +z along the view, in metres. NDC, after division by w, is [0,1] x [0,1] over the
/// picture with (0,0) in its upper left corner; its z is 1 / depth and only keeps the matrix
/// invertible.
void set_camera_attributes(PictureHeader& image, const Camera& camera, int width, int height);

}  // namespace photile
