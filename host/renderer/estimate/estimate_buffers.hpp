// Estimates of a batch of hits: how the kernels keep the sums of a hit (kernels/estimate/sums.clh),
// the estimates on the device, and their way to the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "device/context.hpp"
#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

/// Bytes of the largest buffer, and of all, for one hit.
struct EstimateBytes {
  std::uint64_t largest = 0, together = 0;
};

/// Where the estimates of a hit lie. Kernels are compiled with its symbols and buffers are made in
/// its sizes: both must come from one object, or kernels write beyond the buffers.
struct LightSums {
  std::uint32_t lights = 1;
  bool many_lights = false;
  bool glossy = false;
  /// Estimates that a hit has room for: one per light, or with many lights min(k, lights) slots.
  std::uint32_t per_hit = 1;
  /// Many lights: positions of the hash table that finds a light's slot. Half of them stay empty,
  /// unless each light has its own.
  std::uint32_t table = 0;

  LightSums() = default;
  /// Kernels may be given any k up to `neighbours`.
  LightSums(const SceneNeeds& needs, std::uint32_t neighbours);

  /// The symbols of sums.clh.
  void set_defines(device::Defines& defines) const;
  /// Bytes of the hash table.
  std::size_t table_bytes() const;
  /// Bytes of the arrays that a work-item keeps in private memory.
  std::size_t private_bytes() const;
  /// Bytes that EstimateBuffers has for a hit.
  EstimateBytes bytes_per_hit() const;
};

/// Kept from batch to batch and from call to call: new memory, which the operating system must
/// clear first, takes as long as a good part of the estimates that are written to it. Released
/// where memory runs out between two batches.
class EstimateBuffers final : private device::Reclaimer {
 public:
  /// Buffers for kernels that are compiled with the symbols of `sums`.
  EstimateBuffers(device::Context& context, const LightSums& sums);
  EstimateBuffers(const EstimateBuffers&) = delete;
  EstimateBuffers& operator=(const EstimateBuffers&) = delete;

  /// Makes room for the estimates of this many hits, all zero.
  void begin(std::uint32_t hits);
  /// What the kernels left becomes the estimates of the hits [first, first + hits) in `result`,
  /// which has room for them; with many lights it is appended. Waits for the kernels.
  void read(LightTable& result, std::size_t first);

  device::Buffer<float> irradiance, radiance;  ///< 3 per estimate; radiance in glossy scenes
  // With many lights:
  device::Buffer<std::uint16_t> slot_light;   ///< of each slot
  device::Buffer<std::uint32_t> slots_taken;  ///< per hit, and a 0

 private:
  bool reclaim() override;
  void release();
  void allocate();
  LightTable read_slots();
  void read_vectors(const device::Buffer<float>& buffer, std::span<glm::vec3> values);

  device::Context& context_;
  LightSums sums_;
  std::uint32_t hits_ = 0;      ///< of the batch
  std::uint32_t capacity_ = 0;  ///< hits that the buffers have room for
  bool in_use_ = false;         ///< from begin() to the end of read()
  device::ReclaimerEntry reclaimer_;
};

}  // namespace photile::estimate
