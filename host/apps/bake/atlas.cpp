#include "bake/atlas.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace photile::bake {

std::optional<Atlas> pack(std::span<TexelRectangle> rectangles, std::uint32_t most_side) {
  std::vector<std::size_t> order(rectangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(rectangles[b].height, rectangles[b].width, a) <
           std::tuple(rectangles[a].height, rectangles[a].width, b);
  });
  double area = 0;
  std::uint32_t widest = 1;
  for (const TexelRectangle& rectangle : rectangles) {
    area += double{static_cast<double>(rectangle.width)} * rectangle.height;
    widest = std::max(widest, rectangle.width);
  }
  if (widest > most_side) return std::nullopt;
  const double square = std::ceil(std::sqrt(area));
  const auto width = static_cast<std::uint32_t>(
      std::clamp(square, static_cast<double>(widest), static_cast<double>(most_side)));
  std::uint64_t shelf = 0, x = 0, height = 0;
  for (const std::size_t i : order) {
    TexelRectangle& rectangle = rectangles[i];
    if (x + rectangle.width > width) {
      shelf = height;
      x = 0;
    }
    if (x == 0) height = shelf + rectangle.height;
    if (height > most_side) return std::nullopt;
    rectangle.x = static_cast<std::uint32_t>(x);
    rectangle.y = static_cast<std::uint32_t>(shelf);
    x += rectangle.width;
  }
  return Atlas{width, static_cast<std::uint32_t>(std::max<std::uint64_t>(height, 1))};
}

}  // namespace photile::bake
