// Estimates of a batch of hits on the device, and their way to the host.
#pragma once

#include <cstdint>

#include "device/context.hpp"
#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

/// Bytes of the largest buffer, and of all, for one hit.
struct EstimateBytes {
  std::uint64_t largest = 0, together = 0;
};
EstimateBytes estimate_bytes_per_hit(const SceneNeeds& needs, std::uint32_t neighbours);

class EstimateBuffers {
 public:
  EstimateBuffers(device::Context& context, const SceneNeeds& needs, std::uint32_t neighbours,
                  std::uint32_t hits);

  /// What the kernels left. Waits for them.
  Estimates read();

  device::Buffer<float> irradiance, radiance;  ///< 3 per estimate; radiance in glossy scenes
  // With many lights:
  device::Buffer<std::uint16_t> slot_light;   ///< of each slot
  device::Buffer<std::uint32_t> slots_taken;  ///< per hit, and a 0

 private:
  Estimates read_slots();

  device::Context& context_;
  SceneNeeds needs_;
  std::uint32_t hits_, slots_;
};

}  // namespace photile::estimate
