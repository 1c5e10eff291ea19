// Primary hits and the surface index on the device, and how many hits are estimated at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/context.hpp"
#include "maps/map_store.hpp"
#include "photile/device/query.h"
#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "photile/surface_index.hpp"

namespace photile::estimate {

struct SurfaceBuffers {
  /// The components of `surface` on which the photons of `store` landed count as lit. A reference
  /// to `surface` is kept.
  SurfaceBuffers(const maps::MapStore& store, const Scene& scene, const SurfaceIndex& surface);

  const SurfaceIndex& index;
  std::vector<glm::vec3> centroid;  ///< per triangle
  device::Buffer<PhotileSurfaceNode> nodes;
  device::Buffer<PhotileSurfaceLeaf> leaves;
};

/// Hits [first, first + count) of PrimaryHits.
struct HitBuffers {
  std::uint32_t count = 0;
  device::Buffer<PhotileHit> hits = {};
  device::Buffer<std::uint32_t> order = {};         ///< by map; empty: the order of the hits
  device::Buffer<PhotileHitSurface> surfaces = {};  ///< where normals are compared or areas clipped
  device::Buffer<PhotileHitLobe> lobes = {};        ///< in glossy scenes
};

/// Device memory that a hit takes as input.
///   normals   whether normals of faces are uploaded
///   clipped   whether areas are clipped
std::uint64_t hit_bytes(const SceneNeeds& needs, bool normals, bool clipped);

/// The hits [first, first + maps.size()).
///   maps      of those hits
///   normals   per oriented face, if a map is filtered by normals (maps::MapStore::normals); or
///             empty
///   surface   where areas are clipped, else null
///   needs     of which `glossy` requests lobes
HitBuffers upload_hits(device::Context& context, const PrimaryHits& hits, std::size_t first,
                       std::span<const std::uint32_t> maps, std::span<const glm::vec3> normals,
                       const SurfaceBuffers* surface, const SceneNeeds& needs);

/// Device memory that each hit of a batch takes.
struct HitBatchNeeds {
  std::uint64_t largest_bytes_per_hit;  ///< in the largest buffer, input or output
  std::uint64_t bytes_per_hit;          ///< in all together
};

/// Hits of a batch, at least one: as many as keep each buffer within `largest_buffer` and within
/// what 32 bits address, all buffers within a quarter of `memory` (the rest is for photon maps),
/// and no more than it takes to occupy a device.
std::size_t plan_hit_batch(const HitBatchNeeds& needs, std::uint64_t largest_buffer,
                           std::uint64_t memory);

/// Runs work in batches, smaller ones where the device's memory does not suffice.
class HitBatches {
 public:
  explicit HitBatches(device::Context& context) : context_(context) {}

  /// Calls work(first, count) for hits [0, hits) in order. A call that throws DeviceMemoryError is
  /// repeated with half as many hits, and so are the later ones. Errors: DeviceMemoryError where a
  /// single hit does not fit.
  template <class Work>
  void run(std::size_t hits, const HitBatchNeeds& needs, const Work& work) {
    const std::size_t planned =
        plan_hit_batch(needs, context_.largest_buffer(), context_.memory_limit());
    for (std::size_t first = 0; first < hits;) {
      const std::size_t count = std::min({planned, most_, hits - first});
      try {
        work(first, count);
        first += count;
      } catch (const DeviceMemoryError&) {
        if (count == 1) throw;
        most_ = count / 2;
      }
    }
  }

 private:
  device::Context& context_;
  std::size_t most_ = static_cast<std::size_t>(-1);  ///< the most hits that have not failed
};

}  // namespace photile::estimate
