// The available tunings, and the variant of the estimate kernels that a scene and a tuning need.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "device/context.hpp"
#include "estimate/estimate_buffers.hpp"
#include "photile/estimator.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

inline constexpr std::array vector_widths = {1, 4, 8, 16};
inline constexpr std::array lane_widths = {16, 32, 64};  ///< of EstimateStrategy::lanes
inline constexpr int warp_width = 32;                    ///< of NVIDIA's devices
inline constexpr int max_hits_per_item = 64;
inline constexpr int max_work_group_size = 256;

/// "" for a tuning for which kernels exist, else what is wrong with it.
std::string tuning_problem(const EstimateTuning& tuning);

/// Private memory that the work-items of a group may use together. PoCL keeps a whole group's
/// private arrays on the stack of the thread that runs it, 8 MiB with the usual limit and less on
/// other libcs; a group beyond it ends the process. It is also what stays in a CPU's second-level
/// cache.
inline constexpr std::size_t max_private_bytes_per_group = 512u << 10;

/// Distances that kernels/estimate/candidates.clh keeps at most. Nearly every block of k = 1,000
/// fits, also where surfaces share a map; with a quarter of that many it is walked again by each
/// pass, which takes twice as long.
inline constexpr int largest_capacity = 12800;

/// The largest capacity of scalar kernels, whose chunks are of one: a group of 64 work-items stays
/// within max_private_bytes_per_group.
inline constexpr int largest_scalar_capacity = 800;

/// The largest capacity for the lanes of a group, which keep candidates in local memory. A group
/// may have at least 32 KiB on any device with a full profile; half of it leaves room for two
/// groups.
inline constexpr int largest_lane_capacity = 4096;

/// Local memory that every device with a full profile has.
inline constexpr std::size_t max_local_bytes = 32u << 10;

/// Compile-time choices of kernels/estimate, and how to launch them.
struct Specialisation {
  EstimateStrategy strategy = EstimateStrategy::select;
  int vector_width = 1;  ///< floats per vector: 1, 4, 8 or 16; work-items of `lanes`: 16, 32 or 64
  /// Distances kept, in private memory by `select`, in local by `lanes`.
  int capacity = 256;
  int neighbours = 1;     ///< k
  bool shuffles = false;  ///< `lanes` exchange values by shuffle instructions
  int hits_per_item = 1;  ///< neighbouring hits that a work-item estimates in turn
  std::size_t work_group_size = 64;
  SceneNeeds needs;
  LightSums sums;

  device::Defines defines() const;
  /// Work-items that estimate `hits` hits.
  std::size_t work_items(std::uint32_t hits) const;
  /// Work-items of nearest.cl for `hits` hits.
  std::uint32_t nearest_items(std::uint32_t hits) const;
  /// Bytes of the arrays that one work-item keeps in private memory.
  std::size_t private_bytes() const;
  /// Bytes of local memory of a group: kernels/estimate/lane_path.clh. 0 except for `lanes`.
  std::size_t local_bytes() const;
};

/// The most memory that a device other than a CPU keeps for a work-item: the limit of AMD's
/// work-items.
inline constexpr std::size_t max_private_bytes = 16u << 10;

/// The capacities hold the candidates that k photons usually need. Where the
/// lists of a group of `lanes` would not fit into max_local_bytes, the strategy becomes `select`;
/// work-groups are halved until their private memory is within max_private_bytes_per_group.
Specialisation specialise(const EstimateTuning& tuning, const SceneNeeds& needs, int neighbours);

/// The same by one work-item a hit, whose memory does not depend on k: any device runs it.
Specialisation independent_of_k(Specialisation choice);

/// Whether a device has the resources that the built kernel of a choice takes.
bool fits(const Specialisation& choice, const device::KernelResources& taken,
          const DeviceInfo& device);

}  // namespace photile::estimate
