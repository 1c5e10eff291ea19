#include "support/morton_order.hpp"

#include <algorithm>
#include <numeric>

namespace photile::bench {
namespace {

constexpr int bits_per_axis = 10;

std::uint32_t morton_code(const glm::uvec3& cell) {
  std::uint32_t code = 0;
  for (int bit = bits_per_axis - 1; bit >= 0; --bit) {
    for (int axis = 0; axis < 3; ++axis) code = 2 * code + ((cell[axis] >> bit) & 1u);
  }
  return code;
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> positions) {
  std::vector<std::uint32_t> order(positions.size());
  if (positions.empty()) return order;
  glm::vec3 low = positions[0], high = positions[0];
  for (const glm::vec3& position : positions) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  const glm::vec3 scale =
      static_cast<float>((1 << bits_per_axis) - 1) / glm::max(high - low, glm::vec3(1e-30f));
  std::vector<std::uint32_t> codes(positions.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    codes[i] = morton_code(glm::uvec3((positions[i] - low) * scale));
  }
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

}  // namespace photile::bench
