// A batch of primary hits on the device.
#pragma once

#include <cstdint>

#include "device/context.hpp"
#include "photile/primary_hits.hpp"

namespace photile::estimate {

/// Hits [first, first + count) of PrimaryHits. The lobe's buffers are empty unless glossy.
struct HitBuffers {
  std::uint32_t count = 0;
  device::Buffer<float> position;          ///< 3 per hit, metres
  device::Buffer<std::uint32_t> map;       ///< sided triangle
  device::Buffer<float> outgoing, normal;  ///< 3 per hit, unit
  device::Buffer<float> albedo, specular;  ///< 3 per hit
  device::Buffer<float> roughness;         ///< 1 per hit
};

/// Device memory that a hit takes as input.
std::uint64_t hit_bytes(bool glossy);

HitBuffers upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                       std::size_t count, bool glossy);

}  // namespace photile::estimate
