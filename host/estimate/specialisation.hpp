// Which variant of the estimate kernels a scene and a device need.
#pragma once

#include "device/context.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

/// Compile-time choices of kernels/estimate.
struct Specialisation {
  int vector_width = 1;   ///< floats per vector: 1, 4, 8 or 16
  int capacity = 160;     ///< distances kept in private memory
  int hits_per_item = 1;  ///< neighbouring hits that a work-item estimates in turn
  bool multiple_lights = false;
  bool glossy = false;

  device::Defines defines() const;
};

/// Vector width 16 on every CPU, whatever its own width, so that results agree in every bit between
/// CPUs; scalar elsewhere, where work-items are the lanes. The capacity holds the block of cells
/// that k photons usually need.
Specialisation specialise(const DeviceInfo& device, const SceneNeeds& needs, int neighbours);

}  // namespace photile::estimate
