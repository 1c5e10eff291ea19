// Times of all structures on photons and queries that a user brings, without a scene.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "photile/defaults.hpp"
#include "support/bench_record.hpp"

namespace photile::bench {

struct PointBenchSettings {
  std::filesystem::path photons, queries;               ///< see read_points
  std::vector<int> neighbours;                          ///< values of k
  double radius = 0;                                    ///< metres; 0 = automatic_radius for each k
  std::vector<std::string> structures = {};             ///< names; empty = all
  float photons_per_cell = defaults::photons_per_cell;  ///< of uniform grids

  bool wants(const std::string& structure) const {
    return structures.empty() ||
           std::find(structures.begin(), structures.end(), structure) != structures.end();
  }
};

/// Times the structures that are requested, but for those of a map each, on every device of
/// options.device ("" = all), and nanoflann and Embree on the host. What the rows hold:
/// docs/kernels/points.md. Returns false where a radius or an irradiance is not the oracle's.
/// Errors: those of read_points, of PhotonCloud and of the devices.
bool run_point_bench(const BenchOptions& options, const PointBenchSettings& settings);

}  // namespace photile::bench
