// The costs of the stages of a rendering, over all its photon passes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cache/surface_cache.hpp"
#include "photile/photon_maps.hpp"
#include "photile/photons.hpp"
#include "photile/statistics.hpp"
#include "render/shared_photons.hpp"

namespace photile {

/// Times add up over passes; bytes are those of the pass that took the most.
struct StageCost {
  TimeTaken time;
  std::uint64_t host_bytes = 0;
  std::uint64_t device_bytes = 0;

  void add(const TimeTaken& time, std::uint64_t host_bytes = 0, std::uint64_t device_bytes = 0);
};

/// The cost of a stage, in the form of a run's record.
StageStatistics stage(const char* name, const StageCost& cost,
                      std::vector<std::pair<std::string, double>> figures = {});

/// Adds time to the row of a stage; to a new one at the end where there is none.
void add_time(RunStatistics& stages, const char* name, const TimeTaken& time);

/// The time and the hits of the light of a pass so far.
struct LightTotals {
  TimeTaken asked;             ///< all of it
  TimeTaken filling;           ///< of that: filling nodes; without light maps as `building`
  TimeTaken building;          ///< of that: building photon maps, where these are first needed
  double compile_seconds = 0;  ///< of kernels, where there are no light maps
  std::uint64_t hits = 0;      ///< that had an estimate
  std::uint64_t nodes = 0, node_bytes = 0;
  cache::ErrorSum errors;
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

  // Where several processes share the rendering.
  SentData sent;
  std::vector<std::pair<std::string, double>> processes;  ///< figures of all

  void count(const PhotonTracerResult& traced);
  /// Maps of one kind of photons, on each device.
  void add(std::span<const PhotonMaps> maps, const TimeTaken& time);
  /// The maps of all light.
  void note_last(const PhotonMapStatistics& statistics);
  /// What was done since.
  void add(const LightTotals& before, const LightTotals& now);

  /// Resets the costs of the last picture, but not those of the maps.
  void start_picture();

  /// The stages in their order, with figures.
  RunStatistics statistics() const;
};

}  // namespace photile
