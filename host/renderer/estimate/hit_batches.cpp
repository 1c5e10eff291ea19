#include "estimate/hit_batches.hpp"

namespace photile::estimate {

std::size_t plan_hit_batch(const HitBatchNeeds& needs, std::uint64_t largest_buffer,
                           std::uint64_t memory) {
  constexpr std::uint64_t comfortable = 1u << 20;
  // Kernels index outputs in 32 bits; in bytes, so that no index of any type comes near.
  const std::uint64_t buffer = std::min<std::uint64_t>(largest_buffer, 0xFFFF'FFFFu);
  const std::uint64_t most =
      std::min(buffer / needs.largest_bytes_per_hit, memory / 4 / needs.bytes_per_hit);
  return std::clamp<std::uint64_t>(most, 1, comfortable);
}

}  // namespace photile::estimate
