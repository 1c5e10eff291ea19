// The text of a progress bar.
#pragma once

#include <cstdint>
#include <string>

namespace photile::app {

/// How far a stage is.
struct StageProgress {
  std::string stage;
  std::uint64_t done = 0;
  std::uint64_t total = 0;  ///< 0 where it is not known
  std::string unit;         ///< what is counted: "paths", "triangles", ...
  double seconds = 0;       ///< since the stage began
};

/// "trace photons  [=====>    ]  52%  4.1 s | 3.8 s  1.9M paths/s" (elapsed | remaining), at most
/// `width` - 1 characters: a full last column would wrap on some terminals.
std::string progress_bar(const StageProgress& progress, int width);

/// "trace photons: 52%, 4.1 s, 3.8 s left", for an output that is no terminal.
std::string progress_text(const StageProgress& progress);

/// "trace photons: 7.90 s, 1.9M paths/s", once the stage is complete.
std::string completed_text(const StageProgress& progress);

}  // namespace photile::app
