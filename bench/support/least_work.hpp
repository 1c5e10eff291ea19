// What a search of the k nearest photons cannot do without, to say how near its time comes to that.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

namespace photile::bench {

/// Positions and fluxes of k photons a query and the query are read, the estimate is written; a
/// distance takes eight operations and a sum three.
struct LeastWork {
  double bytes, operations;

  LeastWork(std::size_t queries, int k)
      : bytes(static_cast<double>(queries) * (24.0 * k + 24)),
        operations(static_cast<double>(queries) * 11.0 * k) {}

  /// Adds "bytes", "operations", "GB/s" and "GFLOP/s" to a row of so many seconds.
  void add_to(nlohmann::json& row, double seconds) const {
    constexpr double giga = 1e9;
    row["bytes"] = bytes;
    row["operations"] = operations;
    row["GB/s"] = bytes / seconds / giga;
    row["GFLOP/s"] = operations / seconds / giga;
  }
};

}  // namespace photile::bench
