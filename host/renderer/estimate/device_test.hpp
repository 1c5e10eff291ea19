// A plane of random photons, seen from above, to compile, test and time kernels.
#pragma once

#include <cstddef>

#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"

namespace photile::estimate {

struct PlaneSampleSize {
  std::size_t photons = 0;
  int hits_per_side = 0;  ///< hits lie on a jittered grid
};

/// A square of two triangles with photons on its front, uniform and independent; hits sorted as
/// PrimaryHits are. Equal arguments give equal samples on every machine.
struct PlaneSample {
  Scene scene;
  Photons photons;
  PrimaryHits hits;
  double radius = 0;  ///< metres: twice the expected distance of the k-th photon
};

PlaneSample make_plane_sample(const SceneNeeds& needs, int neighbours, const PlaneSampleSize& size);

}  // namespace photile::estimate
