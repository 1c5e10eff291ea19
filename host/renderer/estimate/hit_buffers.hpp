// A batch of primary hits on the device.
#pragma once

#include <cstdint>
#include <span>

#include "device/context.hpp"
#include "estimate/surface_buffers.hpp"
#include "photile/device/query.h"
#include "photile/primary_hits.hpp"

namespace photile::estimate {

/// Hits [first, first + count) of PrimaryHits.
struct HitBuffers {
  std::uint32_t count = 0;
  device::Buffer<PhotileHit> hits;
  device::Buffer<PhotileHitSurface> surfaces;  ///< where normals are compared or areas clipped
  device::Buffer<PhotileHitLobe> lobes;        ///< in glossy scenes
};

/// Device memory that a hit takes as input.
///   normals   whether normals of faces are uploaded
///   clipped   whether areas are clipped
std::uint64_t hit_bytes(const SceneNeeds& needs, bool normals, bool clipped);

/// Makes `buffers` those of the hits [first, first + maps.size()), in place of others where they
/// have room. Kernels that use them must have ended; others may run.
///   maps      of those hits
///   normals   per sided triangle, if a map is mixed (maps::MapStore::normals), else empty
///   surface   where areas are clipped, else null
///   needs     of which `glossy` asks for lobes
void upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                 std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                 const SurfaceBuffers* surface, const SceneNeeds& needs, HitBuffers& buffers);

}  // namespace photile::estimate
