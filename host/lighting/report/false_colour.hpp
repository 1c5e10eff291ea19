// False colour: the colours and steps of values, with the options of Radiance's falsecolor, and
// pictures of illuminance and luminance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/layered_picture.hpp"
#include "report/palette.hpp"

namespace photile::report {

/// How values are drawn.
enum class Contours {
  none,   ///< each in its colour
  lines,  ///< isolines alone (-cl)
  bands,  ///< bands of a fifth of a step around the isolines (-cb)
  steps   ///< each in the colour of the middle of its step: posterized (-cp)
};

struct FalseColour {
  double scale = 1000;                 ///< top of the scale (-s); 0 = automatic_top (-s auto)
  std::string label = "lux";           ///< -l
  int steps = defaults::legend_steps;  ///< of the legend, and isolines (-n)
  double decades = 0;                  ///< > 0: a logarithmic scale over these (-log)
  std::string palette = "turbo";       ///< -pal
  Contours contours = Contours::none;
};

/// The largest of the values but the uppermost 2%, such as lamps that are seen; 0 where none is
/// positive. NaN and infinities do not count.
double automatic_top(std::span<const float> values);

/// The least number that is not below and whose steps have round middles: 10, 30, 50 ..., or 60,
/// 180, 300 ...
double rounded_top(double top, int steps);

/// A FalseColour whose automatic scale ends at `automatic`.
class ColourScale {
 public:
  /// Errors: UsageError for an unknown palette.
  ColourScale(const FalseColour& options, double automatic);

  /// The colour of a value; of the middle of its step with Contours::steps.
  std::string hex(double value) const { return palette_.hex(drawn_fraction(value)); }
  std::array<std::uint8_t, 3> rgb(double value) const { return palette_.at(drawn_fraction(value)); }
  double top() const { return top_; }
  /// The value at a share in [0, 1] of the scale.
  double value_at(double share) const;
  /// Where isolines are drawn: the middles of the legend's steps, as falsecolor has them,
  /// ascending.
  std::vector<double> levels() const;
  /// Whether a value lies within one of them.
  bool in_band(double value) const;
  /// Number of levels below a value: isolines run where it changes.
  int levels_below(double value) const;

 private:
  double share_of(double value) const;
  double drawn_fraction(double value) const;

  double top_, decades_;
  int steps_;
  bool stepped_;
  Palette palette_;
};

/// Illuminance of the surface that each pixel sees, by all lights together: lux, row 0 at the top.
/// Errors: InputError naming a light whose illuminance is not known; those of `read`.
std::vector<float> illuminance_of(const LayeredPicture& picture);

/// Luminance of each pixel, cd/m2, row 0 at the top. Errors: InputError where the picture does not
/// say how many cd/m2 its values are (the attribute `whiteLuminance`), or has no R, G, B.
std::vector<float> luminance_of(const Image& picture);

/// Puts values into their colours; of isolines and bands only pixels that lie on one, over what
/// `rgb` shows.
///   values   of each pixel, rows of `width`
///   rgb      8-bit sRGB, 3 bytes a pixel
/// Errors: UsageError for an unknown palette.
void draw_false_colour(std::span<const float> values, int width, const FalseColour& options,
                       std::span<std::uint8_t> rgb);

/// Values in their colours, at the top left, and beside them a legend; display-referred, as
/// write_png takes it. Letters are drawn where the font DejaVu Sans is installed.
///   displayed   what isolines and bands lie over: display-referred R, G, B of as many pixels
/// Errors: as above.
Image false_colour_picture(std::span<const float> values, const Image& displayed,
                           const FalseColour& options);

}  // namespace photile::report
