// How a camera stands or moves, files that say so, and values between keyframes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <span>

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

/// Reads a view of Radiance (`rpict -vf FILE`): the last line with one counts. Types -vtv, -vth,
/// -vta and -vtl; what is not given is Radiance's default. In the scene file's world. Errors:
/// InputError naming the file and the option, such as those of shifted or clipped views.
Camera read_radiance_view(const std::filesystem::path& file);

/// Keyframes `index` and index + 1 around a time, and how far it lies between them.
struct Between {
  std::size_t index;
  double share;  ///< in [0, 1]
};

/// The keyframes around a time among ascending ones; before the first and after the last time it
/// stays there. With one keyframe the fraction is 0.
Between between(std::span<const double> times, double time);

/// Cubic Hermite curve: from value a with tangent at_a, per unit of share, to b.
template <class T>
T hermite(const T& a, const T& at_a, const T& b, const T& at_b, double share) {
  const double s = share, s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * a + (s3 - 2 * s2 + s) * at_a + (3 * s2 - 2 * s3) * b +
         (s3 - s2) * at_b;
}

/// A smooth curve through points at ascending times: see read_camera_path.
glm::dvec3 smooth(std::span<const double> times, std::span<const glm::dvec3> values, double time);

/// Straight lines between them.
glm::dvec3 linear(std::span<const double> times, std::span<const glm::dvec3> values, double time);

}  // namespace photile::reading
