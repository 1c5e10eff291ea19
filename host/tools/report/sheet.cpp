#include "tools/report/sheet.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <utility>

#include "image/srgb.hpp"

namespace photile::image {
namespace {

constexpr const char* font = "DejaVuSans";

}  // namespace

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
    linear[c] = static_cast<float>(linear_from_srgb(srgb[c] / 255.0));
  }
  set(x, y, linear);
}

void Sheet::write(int x, int y, int end, const std::string& text) {
  const int width = std::min(end, image_.width) - x;
  constexpr int ascent = 2 * font_size, height = 3 * font_size;  // room for any letter
  if (width <= 0) return;
  OIIO::ImageBuf ink(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
  if (!OIIO::ImageBufAlgo::render_text(ink, 0, ascent, text, font_size, font, 1.0f)) {
    ink.geterror();  // fetched, or OpenImageIO prints it
    return;
  }
  for (int v = std::max(0, ascent - y); v < std::min(height, image_.height - y + ascent); ++v) {
    for (int u = 0; u < width; ++u) {
      const float black = std::clamp(ink.getchannel(u, v, 0, 0), 0.0f, 1.0f);
      for (auto& channel : image_.channels) channel[index(x + u, y + v - ascent)] *= 1 - black;
    }
  }
}

int Sheet::width_of(const std::string& text) {
  const OIIO::ROI size = OIIO::ImageBufAlgo::text_size(text, font_size, font);
  return size.defined() ? size.width() : 0;
}

Image Sheet::take() { return std::move(image_); }

}  // namespace photile::image
