// The light that lobes reflect, by rays: from the surface that an eye ray ended on, along its lobe,
// from surface to surface.
#pragma once

#include <cstdint>

#include "trace/eye_path.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// Where a sample of a pixel has its random numbers from.
struct PixelSample {
  const RandomStream& of_pixel;  ///< sequences that all samples of the pixel share
  std::uint32_t index;           ///< of the sample, into them
  std::uint64_t path;            ///< of the sample alone, as RandomStream numbers them
  std::uint32_t ray = 0;         ///< of those that follow the sample's first lobe
};

/// Follows the lobe of `end`, and those of the surfaces met, and appends what each reflects beside
/// its lobe to `record`, and lamps seen in lobes: at each surface a lamp is looked at, and one
/// direction of the lobe is followed; what both would find is weighed by the power heuristic (Veach
/// and Guibas 1995). Directions are those of visible normals (ggx.hpp). What reflects little goes
/// on by Russian roulette.
void follow_lobes(const EyeSetup& setup, EyeEnd end, const PixelSample& sample, EyeRecord& record);

}  // namespace photile::trace
