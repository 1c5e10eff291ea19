#include "view/frame_size.hpp"

#include <algorithm>
#include <cmath>

namespace photile::view {

void FrameSize::record(double pixels, double seconds) {
  const double latest = seconds / pixels;
  constexpr double weight = 0.3;  // of the newest frame: steady, and adapted in a few frames
  seconds_per_pixel_ =
      seconds_per_pixel_ > 0 ? (1 - weight) * seconds_per_pixel_ + weight * latest : latest;
}

std::pair<int, int> FrameSize::fit(int width, int height) const {
  if (seconds_per_pixel_ <= 0) return {width, height};
  const double pixels = static_cast<double>(width) * height;
  const double scale = std::clamp(std::sqrt(budget_ / (seconds_per_pixel_ * pixels)), 1.0 / 8, 1.0);
  const auto scaled = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(length * scale)));
  };
  return {scaled(width), scaled(height)};
}

}  // namespace photile::view
