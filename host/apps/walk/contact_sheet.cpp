#include "walk/contact_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "photile/defaults.hpp"
#include "photile/limits.hpp"

namespace photile::walk {
namespace {

constexpr int gap = 4;          ///< pixels
constexpr float paper = 0.05f;  ///< linear grey

/// Means of a plane over pixels [x0, x1) x [y0, y1).
float mean(const std::vector<float>& plane, int width, int x0, int x1, int y0, int y1) {
  double sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      sum +=
          static_cast<double>(plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)]);
    }
  }
  return static_cast<float>(sum / ((x1 - x0) * (y1 - y0)));
}

}  // namespace

ContactSheet::ContactSheet(int frames, int width, int height)
    : columns_(static_cast<int>(std::ceil(std::sqrt(frames)))) {
  const int rows = (frames + columns_ - 1) / columns_;
  const int most = limits::max_image_side / std::max(columns_, rows) - gap;
  width_ = std::clamp(std::min(width, defaults::contact_sheet_width), 1, std::max(1, most));
  height_ = std::clamp(static_cast<int>(std::lround(double(width_) * height / width)), 1,
                       std::max(1, most));
  image_.width = columns_ * (width_ + gap) + gap;
  image_.height = rows * (height_ + gap) + gap;
  for (const char* channel : {"R", "G", "B"}) image_.add(channel).assign(image_.pixels(), paper);
}

void ContactSheet::add(int index, const Image& displayed) {
  const int left = gap + index % columns_ * (width_ + gap);
  const int top = gap + index / columns_ * (height_ + gap);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = displayed.channels[channel];
    for (int y = 0; y < height_; ++y) {
      const int y0 = y * displayed.height / height_;
      const int y1 = std::max(y0 + 1, (y + 1) * displayed.height / height_);
      for (int x = 0; x < width_; ++x) {
        const int x0 = x * displayed.width / width_;
        const int x1 = std::max(x0 + 1, (x + 1) * displayed.width / width_);
        image_.channels[channel]
                       [static_cast<std::size_t>(top + y) * static_cast<std::size_t>(image_.width) +
                        static_cast<std::size_t>(left + x)] =
            mean(plane, displayed.width, x0, x1, y0, y1);
      }
    }
  }
}

}  // namespace photile::walk
