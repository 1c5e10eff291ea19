// How far a picture is from a reference.
#pragma once

#include <span>
#include <vector>

#include "photile/image.hpp"

namespace photile {

/// Errors of a picture. Pixels that see a lamp, more than 20 times as bright as the reference's
/// median, are left out of all of them, and so are those next to them: their share of a mean would
/// hide the room's, and one sample more or less on the border of a lamp that of all other pixels.
struct PictureError {
  /// Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01 m^2): a the picture, b the reference,
  /// m the mean of b. Its root is the error relative to what is seen, in a pixel.
  double relative_mse = 0;
  double mean_ratio = 1;  ///< mean of the picture over that of the reference
  /// Largest |mean(a) / mean(b) - 1| of the tiles of a sixteenth of the picture's height: bias that
  /// many pixels share, where a pixel's noise has averaged out. Tiles darker than a tenth of m, or
  /// that mostly see lamps, do not count.
  double worst_region = 0;
  /// Where that is: its upper left corner and size, pixels; empty where no tile counts.
  struct Region {
    int x = 0, y = 0, width = 0, height = 0;
  } worst_place;
  /// Peak signal-to-noise ratio of the displayed pictures, decibel: both exposed so that m becomes
  /// mid grey, and clipped at white. Infinite where they are equal.
  double psnr = 0;

  double relative_error() const;  ///< root of relative_mse
};

/// Errors: UsageError when the sizes differ or one lacks R, G and B; InputError when the reference
/// is black.
PictureError picture_error(const Image& picture, const Image& reference);

/// The pixels that count, and what a squared difference of their channels is divided by: 3 x
/// pixels values, 0 where the pixel sees a lamp or is next to one that does. Errors: as above.
class RelativeErrorWeights {
 public:
  explicit RelativeErrorWeights(const Image& reference);

  bool counts(std::size_t pixel) const { return counts_[pixel]; }
  std::size_t counted() const { return counted_; }  ///< pixels
  double mean() const { return mean_; }             ///< of the reference over them and channels
  /// Mean over channels and pixels that count of (a - b)^2 / (b^2 + 0.01 m^2).
  double relative_mse(const Image& picture, const Image& reference) const;

 private:
  std::vector<bool> counts_;
  std::vector<double> divisor_;  ///< 3 x pixels
  std::size_t counted_ = 0;
  double mean_ = 0;
};

}  // namespace photile
