// Light of photons that stand behind something is no light of a hit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/photons.hpp"
#include "photile/ray_scene.hpp"

namespace photile::estimate {

/// Where the wall of a ring stands on a floor, photons inside it lie close to hits outside, and
/// would show as a bright rim there. Caustics end abruptly at what casts them, so that of these it
/// matters.
class VisiblePhotons {
 public:
  /// Keeps a reference to `rays`, and copies of what it needs of the photons.
  VisiblePhotons(const RayScene& rays, const Photons& photons);

  /// Hits of which some estimate is not 0: those that need their neighbours looked at.
  static std::vector<std::uint32_t> lit(const Estimates& estimates, std::size_t hits,
                                        std::size_t lights);

  /// Scales each layer's estimate of a hit by that fraction of the flux of its neighbours which the
  /// hit sees along the surface. The area that they lie on is left whole: beside a wall that stands
  /// in a caustic the estimate is darker, as at the border of any light.
  ///   chosen   of the hits
  ///   near     of the chosen hits
  void leave_out_hidden(const PrimaryHits& hits, std::span<const std::uint32_t> chosen,
                        const NeighbourLists& near, Estimates& estimates) const;

 private:
  const RayScene& rays_;
  std::vector<glm::vec3> position_;
  std::vector<std::uint32_t> oriented_face_;
  std::vector<float> flux_;           ///< luminance
  std::vector<std::uint16_t> light_;  ///< empty for one alone
};

}  // namespace photile::estimate
