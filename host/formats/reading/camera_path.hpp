// How a camera moves, and files that say so.
#pragma once

#include <filesystem>
#include <functional>

#include "photile/camera.hpp"

namespace photile::reading {

/// A camera at any time in [begin, end], seconds; in the scene file's world.
struct CameraMotion {
  double begin = 0, end = 0;
  std::function<Camera(double time)> at;
};

/// Reads a JSON list of keyframes, or an object {"keyframes": [...], "interpolation":
/// "smooth"|"linear"}. A keyframe has "time" (seconds, ascending), "position", "look_at" (a point)
/// or "direction", and may have "up" and "fov" (degrees, vertical); metres in the scene file's
/// world. Missing ups are those of `base`, missing fields of view too.
///
/// Between keyframes "smooth" moves along cubic Hermite curves through the positions, with the
/// tangents of Catmull and Rom ("A class of local interpolating splines", 1974) for uneven times
/// and zero at both ends; "linear" along straight lines. Where all keyframes look at points, those
/// move alike; else orientations turn along the shortest arc (Shoemake, "Animating rotation with
/// quaternion curves", 1985).
/// Errors: InputError naming the file, the keyframe and the key.
CameraMotion read_camera_path(const std::filesystem::path& file, const Camera& base);

}  // namespace photile::reading
