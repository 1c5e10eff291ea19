// Rays that find what a place sees of the sky's patches, and of the surfaces around it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/photometer.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"
#include "weather/sky_patches.hpp"

namespace photile::daylight {

/// Lux at the place for each cd/m2 of a patch, by linear RGB.
struct SeenPatch {
  std::uint32_t patch;  ///< the ground is the one after the sky's
  std::uint32_t batch;
  bool straight;  ///< through panes and holes at most
  glm::vec3 weight;
};

/// Lux at the place for each lux on a surface that reflects light to it.
struct SeenSurface {
  trace::SurfacePoint point;
  std::uint32_t batch;
  float distance;  ///< metres along the ray
  glm::vec3 weight;
};

struct SeenByRays {
  std::vector<SeenPatch> patches;
  std::vector<SeenSurface> surfaces;
};

struct SkyRayParameters {
  int batches = 4;         ///< independent of each other
  std::uint64_t seed = 1;  ///< of the first batch
  int max_specular_depth;  ///< mirrors, glass and lobes that a ray follows
};

/// Half of a place's rays follow its cosine (the response of a sensor), half go through portals;
/// each counts by the density of both together (the balance heuristic of Veach and Guibas, 1995).
/// They go on by mirrors, glass and glossy lobes, and end on a surface's base or in the sky.
class SkyRays {
 public:
  /// References are kept.
  SkyRays(const RayScene& rays, const weather::PatchFinder& patches,
          const SkyRayParameters& parameters);

  /// What a place sees, in the order of its rays. Depends on the place, its number and the
  /// parameters only.
  ///   places   one, or several points of a surface, which take turns
  ///   number   of the place, below 2^31; that of no other
  ///   rays     of each batch
  SeenByRays from(std::span<const trace::Photometer> places, std::uint64_t number, int rays) const;

 private:
  void follow(glm::vec3 origin, glm::vec3 direction, glm::vec3 weight, std::uint32_t batch,
              const trace::RandomStream& random, SeenByRays& seen) const;

  const RayScene& rays_;
  const weather::PatchFinder& patches_;
  SkyRayParameters parameters_;
  trace::Portals portals_;
};

}  // namespace photile::daylight
