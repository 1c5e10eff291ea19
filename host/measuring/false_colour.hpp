// Colours and steps of illuminances, with the options of Radiance's falsecolor.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/palette.hpp"
#include "photile/defaults.hpp"

namespace photile::measuring {

struct FalseColour {
  double scale = 1000;        ///< top of the scale (-s); 0 = the largest value there is (-s auto)
  std::string label = "lux";  ///< -l
  int steps = defaults::legend_steps;  ///< of the legend, and isolines (-n)
  double decades = 0;                  ///< > 0: a logarithmic scale over these (-log)
  std::string palette = "turbo";       ///< -pal
  bool lines_only = false;             ///< isolines on white (-cl)
};

/// A FalseColour for values up to `largest`.
class ColourScale {
 public:
  /// Errors: UsageError for an unknown palette.
  ColourScale(const FalseColour& options, double largest);

  std::string hex(double value) const { return palette_.hex(share_of(value)); }
  std::array<std::uint8_t, 3> rgb(double value) const { return palette_.at(share_of(value)); }
  double top() const { return top_; }
  /// The value at a share in [0, 1] of the scale.
  double value_at(double share) const;
  /// Where isolines are drawn: the middles of the legend's steps, as falsecolor has them,
  /// ascending.
  std::vector<double> levels() const;

 private:
  double share_of(double value) const;

  double top_, decades_;
  int steps_;
  image::Palette palette_;
};

}  // namespace photile::measuring
