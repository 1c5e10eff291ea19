// Estimates of a batch of hits on the device, and their way to the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "device/context.hpp"
#include "photile/estimator.hpp"
#include "photile/scene_needs.hpp"

namespace photile::estimate {

/// Bytes of the largest buffer, and of all, for one hit.
struct EstimateBytes {
  std::uint64_t largest = 0, together = 0;
};
EstimateBytes estimate_bytes_per_hit(const SceneNeeds& needs, std::uint32_t neighbours);

/// Kept from batch to batch and from call to call: new memory, which the operating system must
/// clear first, takes as long as a good part of the estimates that are written to it. Released
/// where memory runs out between two batches.
class EstimateBuffers final : private device::Reclaimer {
 public:
  EstimateBuffers(device::Context& context, const SceneNeeds& needs, std::uint32_t neighbours);
  EstimateBuffers(const EstimateBuffers&) = delete;
  EstimateBuffers& operator=(const EstimateBuffers&) = delete;

  /// Makes room for the estimates of so many hits, all zero.
  void begin(std::uint32_t hits);
  /// What the kernels left becomes the estimates of the hits [first, first + hits) in `result`,
  /// which has room for them; with many lights it is appended. Waits for the kernels.
  void read(Estimates& result, std::size_t first);

  device::Buffer<float> irradiance, radiance;  ///< 3 per estimate; radiance in glossy scenes
  // With many lights:
  device::Buffer<std::uint16_t> slot_light;   ///< of each slot
  device::Buffer<std::uint32_t> slots_taken;  ///< per hit, and a 0

 private:
  bool reclaim() override;
  void release();
  void allocate();
  Estimates read_slots();
  void read_vectors(const device::Buffer<float>& buffer, std::span<glm::vec3> values);

  device::Context& context_;
  SceneNeeds needs_;
  std::uint32_t slots_;
  std::uint32_t hits_ = 0;      ///< of the batch
  std::uint32_t capacity_ = 0;  ///< hits that the buffers have room for
  bool in_use_ = false;         ///< from begin() to the end of read()
  device::ReclaimerEntry reclaimer_;
};

}  // namespace photile::estimate
