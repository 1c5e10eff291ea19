// The light that rays from points find where they end: that of photon estimates, read from light
// maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "cache/batch_sums.hpp"
#include "cache/light_maps.hpp"
#include "light/light_at_points.hpp"
#include "trace/hemisphere_rays.hpp"

namespace photile::cache {

/// The ends of the rays of a run of points, and the light that counts at each.
struct RayEnds {
  trace::HemisphereRays rays;
  std::vector<glm::vec3> weight;  ///< of each end: of irradiance, or of radiance
  /// Of each end: the row of `found`, or, beyond those, `found.size()` more than its nodes have.
  std::vector<std::uint32_t> slot;
  PrimaryHits found;                   ///< ends whose light was found where they are ...
  LightTable light;                    ///< ... and that light: a row for each
  std::vector<BilinearWeights> nodes;  ///< of the ends that may read light maps

  /// Adds what the rays of a point of the run hit; each of its batches has this many rays.
  ///   of_nodes   the light of the nodes
  void add_point(const LightTable& of_nodes, std::size_t point, std::uint32_t batches,
                 std::uint32_t rays_per_batch, BatchSums& sums) const;
};

/// Finds the light where rays end: that of light maps, except on surfaces whose lobe reflects much
/// and where no node is visible from the hit, which get that of `photons`.
///   photons   what a point gets from it does not depend on the points beside it
///   maps      of one level
/// Errors: those of both; Interrupted.
RayEnds light_at_ends(trace::HemisphereRays rays, light::LightAtPoints& photons, LightMaps& maps,
                      const Progress& progress);

}  // namespace photile::cache
