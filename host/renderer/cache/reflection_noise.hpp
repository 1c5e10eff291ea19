// Which reflections need no light gathered at nodes, since photons are not seen in them.
#pragma once

#include <cstdint>
#include <vector>

#include "photile/ray_scene.hpp"

namespace photile::cache {

/// What photon estimates show of their noise.
struct PhotonBlotches {
  double width;  ///< metres, over which estimates err alike
  double noise;  ///< relative
};

/// Whether the light that lobes reflect may be that of photon estimates: where they would add
/// little noise to the pixel, for they err alike within blotches and apart between them, and a
/// pixel sees many of them in a rough or curved surface, or weighs them little. Depends on the hits
/// of a pixel alone; so the same number of a pixel's samples must be there.
///   seen        hits of the pixels themselves
///   reflected   those that lobes reflect
///   runs        of the samples of a pixel, as PrimaryHitParameters has them
/// Returns 1 or 0 for each of `reflected`.
std::vector<std::uint8_t> suits_photons(const PrimaryHits& seen, const PrimaryHits& reflected,
                                        int runs, const PhotonBlotches& blotches);

}  // namespace photile::cache
