// The costs of the stages of a rendering, over all its photon passes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cache/surface_cache.hpp"
#include "photile/statistics.hpp"

namespace photile {

/// Times add up over passes; bytes are those of the pass that took most.
struct StageCost {
  TimeTaken time;
  std::uint64_t host_bytes = 0;
  std::uint64_t device_bytes = 0;

  void add(const TimeTaken& time, std::uint64_t host_bytes = 0, std::uint64_t device_bytes = 0);
};

/// The cost of a stage, as a record of a run has it.
StageStatistics stage(const char* name, const StageCost& cost,
                      std::vector<std::pair<std::string, double>> figures = {});

/// Adds time to the row of a stage; to a new one at the end where there is none.
void add_time(RunStatistics& stages, const char* name, const TimeTaken& time);

/// Points and estimates that went to other processes.
struct PointTraffic {
  std::uint64_t points = 0, bytes = 0;
};

/// Counts add up over passes.
struct RenderCosts {
  StageCost structure, trace, exchange, radius, group, surface, build, estimators, hits, light_maps,
      estimate, film, release;
  std::uint64_t emitted_photons = 0, stored_photons = 0, caustic_photons = 0;
  std::uint64_t group_members = 0, groups = 0, patches = 0;
  std::uint64_t components = 0, surface_leaves = 0;
  std::uint64_t light_map_nodes = 0;
  cache::ErrorSum light_map_errors;                  ///< of what was read from nodes that gather
  std::uint64_t maps = 0, normal_filtered_maps = 0;  ///< of the last pass
  std::vector<std::uint32_t> map_sizes;              ///< of the last pass, as PhotonMapStatistics
  std::uint64_t references = 0, largest_map = 0;
  std::uint64_t rays = 0, hit_count = 0;
  double compile_seconds = 0;                             ///< of all kernels
  double estimate_compile_seconds = 0;                    ///< of them, within `estimate`
  std::vector<std::pair<std::string, double>> fractions;  ///< of several devices

  // Where several processes share the rendering: what this one sent to others, and holds.
  std::uint64_t photons_sent = 0, photon_bytes_sent = 0, photons_held = 0;
  PointTraffic points_sent;                               ///< of the picture
  std::vector<std::pair<std::string, double>> processes;  ///< figures of all

  /// Resets the costs of the last picture, but not those of the maps.
  void start_picture();

  /// The stages in their order, with figures.
  RunStatistics statistics() const;
};

}  // namespace photile
