// The surface index on the device.
#pragma once

#include "device/context.hpp"
#include "maps/map_store.hpp"
#include "photile/surface_index.hpp"

namespace photile::estimate {

struct SurfaceBuffers {
  /// The sheets of `surface` on which the photons of `store` landed count as lit.
  SurfaceBuffers(const maps::MapStore& store, const SurfaceIndex& surface);

  device::Buffer<PhotileSurfaceNode> nodes;
  device::Buffer<PhotileSurfaceLeaf> leaves;
};

}  // namespace photile::estimate
