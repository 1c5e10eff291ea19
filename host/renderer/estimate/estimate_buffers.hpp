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

/// The estimates of a batch.
class EstimateBuffers {
 public:
  /// Those of the hits [first, first + hits) of a table, all zero, for kernels that are compiled
  /// with the symbols of `sums`. Dense tables have zeros there, and must outlive this object.
  EstimateBuffers(device::Context& context, const LightSums& sums, LightTable& result,
                  std::size_t first, std::uint32_t hits);

  /// Turns the output of the kernels into the estimates of these hits; with many lights they are
  /// appended. Waits for the kernels.
  void read();

  device::Buffer<float> irradiance, radiance;  ///< 3 per estimate; radiance in glossy scenes
  // With many lights:
  device::Buffer<std::uint16_t> slot_light;   ///< of each slot
  device::Buffer<std::uint32_t> slots_taken;  ///< per hit, and a final 0

 private:
  LightTable read_slots();
  /// Their part of a column.
  std::span<float> part(std::vector<glm::vec3>& column) const;

  device::Context& context_;
  LightSums sums_;
  LightTable& result_;
  std::size_t first_;
  std::uint32_t hits_;
};

}  // namespace photile::estimate
