// How large frames may be to come at the wanted rate.
#pragma once

#include <utility>

namespace photile::view {

/// Learns from each frame what a pixel costs.
class FrameSize {
 public:
  explicit FrameSize(double frames_per_second) : budget_(1 / frames_per_second) {}

  /// A frame of this many pixels took so long.
  void record(double pixels, double seconds);

  /// Width and height in the window's proportions, at most the window and at least an eighth of it;
  /// the whole before anything was recorded.
  std::pair<int, int> fit(int width, int height) const;

 private:
  double budget_;                 ///< seconds
  double seconds_per_pixel_ = 0;  ///< smoothed; 0 = unknown
};

}  // namespace photile::view
