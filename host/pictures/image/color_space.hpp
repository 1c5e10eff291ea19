// What the values of a picture's pixels stand for: their transfer curves and primaries, and how
// they become linear Rec.709.
#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "image/decoder.hpp"

namespace photile::image {

/// CIE 1931 x and y of the primaries and of their white.
struct Chromaticities {
  glm::dvec2 red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};
};

/// From RGB of these primaries to Rec.709: white stays white, and luminance what it is, exactly,
/// since X and Z alone are scaled where the whites differ. Nothing where it would change no
/// significant bit. Errors: DecodeError where the primaries span no colours.
std::optional<glm::dmat3> to_rec709(const Chromaticities& from);

/// From CIE XYZ whose white is X = Y = Z; luminance stays what it is.
glm::dmat3 rec709_of_xyz();

/// A colour that Rec.709 lacks is mixed with the grey of its luminance until no channel is negative
/// (Radiance's clipgamut). Others, and colours that were negative before, stay.
glm::dvec3 converted(const glm::dmat3& to_rec709, const glm::dvec3& color);

struct ColorSpace {
  /// Stored values of [0,1] to linear ones.
  using Curve = std::function<double(double)>;
  /// Of red, green and blue. Empty: sRGB's for integers, and none for real numbers.
  std::array<Curve, 3> curves;
  std::optional<glm::dmat3> to_rec709;
  /// Why the picture's colours cannot be read; "" where they can.
  std::string problem;

  /// Whether integers are plain sRGB.
  bool is_srgb() const { return !curves[0] && !to_rec709 && problem.empty(); }
};

/// All channels to the power.
ColorSpace gamma_space(double exponent);

/// Of an ICC profile (ISO 15076-1) of three primaries and their curves, or of grey. What it is else
/// is the problem of the space. sRGB's own profile gives plain sRGB.
ColorSpace icc_space(Encoded profile);

/// Of the code points of ITU-T H.273 that a PNG's cICP has.
ColorSpace coded_space(int primaries, int transfer, int matrix, bool full_range);

}  // namespace photile::image
