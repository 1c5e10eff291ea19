// A batch of primary hits on the device.
#pragma once

#include <cstdint>
#include <span>

#include "device/context.hpp"
#include "estimate/surface_buffers.hpp"
#include "photile/primary_hits.hpp"

namespace photile::estimate {

/// Hits [first, first + count) of PrimaryHits. The lobe's buffers are empty unless glossy.
struct HitBuffers {
  std::uint32_t count = 0;
  device::Buffer<float> position;          ///< 3 per hit, metres
  device::Buffer<std::uint32_t> map;       ///< that the hit lies on
  device::Buffer<float> face_normal;       ///< 3 per hit: of its sided triangle; or empty
  device::Buffer<std::uint32_t> place;     ///< 3 per hit: facet, triangle, sheet; or empty
  device::Buffer<float> inwards;           ///< 3 per hit: to its triangle's centroid; or empty
  device::Buffer<float> outgoing, normal;  ///< 3 per hit, unit
  device::Buffer<float> diffuse;           ///< 9 per hit: DiffusePart
  device::Buffer<float> f0;                ///< 3 per hit
  device::Buffer<float> shape;             ///< 2 per hit: GGX alpha and F90
  device::Buffer<float> bump;              ///< 4 per hit, with normal maps; or empty
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
///   needs     of which `glossy` and `normal_maps` ask for lobes
void upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                 std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                 const SurfaceBuffers* surface, const SceneNeeds& needs, HitBuffers& buffers);

}  // namespace photile::estimate
