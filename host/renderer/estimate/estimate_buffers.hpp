// Estimates of a batch of hits on the device, and their way to the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "device/context.hpp"
#include "estimate/light_sums.hpp"
#include "photile/estimator.hpp"

namespace photile::estimate {

/// Kept from batch to batch and from call to call: new memory, which the operating system must
/// clear first, takes as long as a good part of the estimates that are written to it. Released
/// where memory runs out between two batches.
class EstimateBuffers final : private device::Reclaimer {
 public:
  /// For kernels compiled with the symbols of `sums`.
  EstimateBuffers(device::Context& context, const LightSums& sums);
  EstimateBuffers(const EstimateBuffers&) = delete;
  EstimateBuffers& operator=(const EstimateBuffers&) = delete;

  /// Makes room for the estimates of so many hits, all zero.
  void begin(std::uint32_t hits);
  /// What the kernels left becomes the estimates of the hits [first, first + hits) in `result`,
  /// which has room for them; with many lights it is appended. Waits for the kernels.
  ///   after   when those have ended, where others run beside the transfer
  void read(Estimates& result, std::size_t first, const device::Event& after = {});

  device::Buffer<float> irradiance, radiance;  ///< 3 per estimate; radiance in glossy scenes
  // With many lights:
  device::Buffer<std::uint16_t> slot_light;   ///< of each slot
  device::Buffer<std::uint32_t> slots_taken;  ///< per hit, and a 0

 private:
  bool reclaim() override;
  void release();
  void allocate();
  Estimates read_slots();
  void read_vectors(const device::Buffer<float>& buffer, std::span<glm::vec3> values,
                    const device::Event& after = {});

  device::Context& context_;
  LightSums sums_;
  std::uint32_t hits_ = 0;      ///< of the batch
  std::uint32_t capacity_ = 0;  ///< hits that the buffers have room for
  bool in_use_ = false;         ///< from begin() to the end of read()
  device::ReclaimerEntry reclaimer_;
};

}  // namespace photile::estimate
