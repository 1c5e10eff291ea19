#include "report/sheet.hpp"

#include <algorithm>
#include <utility>

#include "image/srgb.hpp"
#include "report/font.hpp"

namespace photile::report {

Sheet::Sheet(int width, int height) {
  image_.width = width;
  image_.height = height;
  for (const char* channel : {"R", "G", "B"}) image_.add(channel).assign(image_.pixels(), 1.0f);
}

std::size_t Sheet::index(int x, int y) const {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
         static_cast<std::size_t>(x);
}

void Sheet::set(int x, int y, const std::array<float, 3>& linear) {
  for (std::size_t c = 0; c < 3; ++c) image_.channels[c][index(x, y)] = linear[c];
}

void Sheet::set(int x, int y, const std::array<std::uint8_t, 3>& srgb) {
  std::array<float, 3> linear{};
  for (std::size_t c = 0; c < 3; ++c) {
    linear[c] = static_cast<float>(image::linear_from_srgb(srgb[c] / 255.0));
  }
  set(x, y, linear);
}

void Sheet::write(int x, int y, int end, const std::string& text) {
  const int right = std::min(end, image_.width);
  Font::dejavu(font_size).draw(text, [&](int u, int v, float ink) {
    u += x;
    v += y;
    if (u < std::max(x, 0) || u >= right || v < 0 || v >= image_.height) return;
    for (auto& channel : image_.channels) channel[index(u, v)] *= 1 - ink;
  });
}

int Sheet::width_of(const std::string& text) { return Font::dejavu(font_size).width_of(text); }

Image Sheet::take() { return std::move(image_); }

}  // namespace photile::report
