// What the tuner times: a plane of random photons, seen from above.
#pragma once

#include <cstddef>

#include "photile/photons.hpp"
#include "photile/primary_hits.hpp"
#include "photile/scene_needs.hpp"

namespace photile::estimate {

/// Sizes of a sample. Enough hits for some milliseconds a launch, photons beyond a CPU's caches of
/// the first and second level.
struct TuningSampleSize {
  std::size_t photons = 200'000;
  int hits_per_side = 256;  ///< hits lie on a jittered grid
};

/// A square of two triangles with photons on its front, uniform and independent; hits sorted as
/// PrimaryHits are. The same for the same arguments, everywhere.
struct TuningSample {
  Scene scene;
  Photons photons;
  PrimaryHits hits;
  double radius = 0;  ///< metres: twice the expected distance of the k-th photon
};

TuningSample make_tuning_sample(const SceneNeeds& needs, int neighbours,
                                const TuningSampleSize& size = {});

}  // namespace photile::estimate
