// The surface index on the device.
#pragma once

#include "device/context.hpp"
#include "maps/map_store.hpp"
#include "photile/scene.hpp"
#include "photile/surface_index.hpp"

namespace photile::estimate {

struct SurfaceBuffers {
  /// The sheets of `surface` on which the photons of `store` landed count as lit. A reference to
  /// `surface` is kept.
  SurfaceBuffers(const maps::MapStore& store, const Scene& scene, const SurfaceIndex& surface);

  const SurfaceIndex& index;
  std::vector<glm::vec3> centroid;  ///< per triangle
  device::Buffer<PhotileSurfaceNode> nodes;
  device::Buffer<PhotileSurfaceLeaf> leaves;
};

}  // namespace photile::estimate
