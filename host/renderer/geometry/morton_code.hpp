// Places along the Morton curve.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace photile::geometry {

/// Interleaves the bits of a cell's numbers, those of x lowest. Numbers are below 2^21.
inline std::uint64_t morton_code(const glm::uvec3& cell) {
  // Puts two zero bits before each bit but the lowest.
  const auto spread = [](std::uint64_t x) {
    x = (x | x << 32) & 0x001F00000000FFFFull;
    x = (x | x << 16) & 0x001F0000FF0000FFull;
    x = (x | x << 8) & 0x100F00F00F00F00Full;
    x = (x | x << 4) & 0x10C30C30C30C30C3ull;
    return (x | x << 2) & 0x1249249249249249ull;
  };
  return spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
}

}  // namespace photile::geometry
