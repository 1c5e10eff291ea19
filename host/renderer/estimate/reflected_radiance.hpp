// What an estimate of a hit says about the light that leaves it.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "photile/estimator.hpp"
#include "photile/ray_scene.hpp"

namespace photile::estimate {

/// Radiance that a hit sends against the ray that arrived, of the light of estimate `index`.
inline glm::vec3 reflected_radiance(const PrimaryHits& hits, std::size_t hit,
                                    const Estimates& estimates, std::size_t index) {
  return estimates.radiance.empty()
             ? hits.diffuse_albedo[hit] * glm::one_over_pi<float>() * estimates.irradiance[index]
             : estimates.radiance[index];
}

/// Calls visit(layer, index) for each estimate of a hit.
///   lights   layers of the scene
template <class Visit>
void for_each_estimate(const Estimates& estimates, std::size_t hit, std::size_t lights,
                       const Visit& visit) {
  if (estimates.first.empty()) {
    for (std::size_t layer = 0; layer < lights; ++layer) visit(layer, hit * lights + layer);
    return;
  }
  for (std::size_t i = estimates.first[hit]; i < estimates.first[hit + 1]; ++i) {
    visit(std::size_t{estimates.light[i]}, i);
  }
}

}  // namespace photile::estimate
