// Rectangles side by side on one picture.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace photile::bake {

struct TexelRectangle {
  std::uint32_t x = 0, y = 0;  ///< its first texel
  std::uint32_t width = 0, height = 0;
};

struct Atlas {
  std::uint32_t width = 0, height = 0;
};

/// Places rectangles on shelves, the highest first (Coffman et al., "Performance bounds for
/// level-oriented two-dimensional packing algorithms", 1980: next-fit decreasing height), on a
/// picture about as wide as high. Nothing where no picture of this side holds them.
std::optional<Atlas> pack(std::span<TexelRectangle> rectangles, std::uint32_t most_side);

}  // namespace photile::bake
