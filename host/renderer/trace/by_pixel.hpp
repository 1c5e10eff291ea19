// Hits, or what else belongs to pixels, in the order of the pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace photile::trace {

/// Which elements belong to each of a range of pixels, in their order.
struct ByPixel {
  std::vector<std::uint32_t> first, index;

  template <class PixelOf>
  ByPixel(std::size_t elements, std::size_t first_pixel, std::size_t pixels, PixelOf pixel_of)
      : first(pixels + 1), index(elements) {
    for (std::size_t i = 0; i < elements; ++i) ++first[pixel_of(i) - first_pixel + 1];
    for (std::size_t p = 0; p < pixels; ++p) first[p + 1] += first[p];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < elements; ++i) {
      index[next[pixel_of(i) - first_pixel]++] = static_cast<std::uint32_t>(i);
    }
  }

  std::span<const std::uint32_t> of(std::size_t pixel) const {
    return std::span(index).subspan(first[pixel], first[pixel + 1] - first[pixel]);
  }
};

}  // namespace photile::trace
