// Several ways to do the same, timed in turn: all see the same load of the machine, so that the
// ratio of two in one round means something where their seconds do not.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "photile/device.hpp"
#include "support/timing.hpp"

namespace photile::bench {

struct Contestant {
  nlohmann::json row;         ///< what is timed, with its "queries" and "k"
  std::function<void()> run;  ///< once; the first call may compile
  /// Adds to the row what is known after the last run; returns how many answers are wrong.
  std::function<std::uint64_t(nlohmann::json& row)> finish;
  Device* device = nullptr;  ///< whose kernels are timed, which needs profiling; null: none
};

/// Runs each once, untimed, then all in rounds, and writes into their rows what each round took:
/// "seconds" that a caller waits, "processor seconds" of all threads, "system seconds" of these in
/// the operating system and, with a device, "kernel seconds". Returns how many answers are wrong,
/// each row's said in a line.
std::uint64_t take_turns(std::vector<Contestant>& contestants, const Repeats& repeats);

}  // namespace photile::bench
