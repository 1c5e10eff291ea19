// The build that the paper starts from: each photon tested against all triangles.
#pragma once

#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "support/timing.hpp"

namespace photile::bench {

struct NaiveBuild {
  Timing timing;           ///< of all photons: those of the tested ones times what they stand for
  std::size_t tested = 0;  ///< photons, evenly among all
  double references = 0;   ///< a photon: oriented faces whose map it enters
};

/// On all hardware threads of the host, nothing written. A photon enters the map of an oriented
/// face that lies within the radius and whose normal agrees with its own triangle's. As many
/// photons are tested as make `most_pairs` pairs with triangles.
NaiveBuild time_naive_build(const Scene& scene, const Photons& photons, double radius,
                            double angle_degrees, const Repeats& repeats, double most_pairs = 2e8);

}  // namespace photile::bench
