// The light at points by path tracing instead of a density of photons: irradiance and reflected
// radiance at points of opaque surfaces. Unbiased and noisy; it shares no code with photon maps.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"
#include "trace/opaque_bsdf.hpp"
#include "trace/ray_query.hpp"

namespace photile {

/// A unique number for each hit of a batch of rows: pixel x samples + sample, below 2^48. It does
/// not depend on how the picture is split into batches, because the order of a pixel's hits does
/// not.
std::vector<std::uint64_t> path_numbers(const PrimaryHits& hits, const PrimaryHitParameters& film,
                                        int first_row, int last_row);

class PathEstimator {
 public:
  /// References are kept. Errors: InputError for an area light without area.
  PathEstimator(const RayScene& rays, std::uint64_t seed);

  /// One path from each hit; work is shared by TBB. Depends on the hits and the numbers alone.
  ///   number   of each hit's path, below 2^48: the same number and hit give the same path
  /// Errors: Interrupted, when `progress` says so.
  LightTable estimate(const PrimaryHits& hits, std::span<const std::uint64_t> number,
                      const Progress& progress = Progress::none()) const;

 private:
  const RayScene& rays_;
  std::uint64_t seed_;
  SceneNeeds needs_;
  trace::LightSampler lights_;
};

// One path of the path tracer: from a point of an opaque surface towards the light that it
// receives.

/// The contribution of one light to the start of a path, with that light's layer at power 1.
struct PathLight {
  std::uint32_t layer;
  glm::vec3 irradiance;  ///< W/m2 or lm/m2
  glm::vec3 radiance;    ///< reflected against the ray that arrived, W/(m2 sr) or cd/m2
};

/// Traces one path and appends what it finds, in order: an unbiased sample of irradiance and
/// reflected radiance (Kajiya, "The rendering equation", 1986). At each surface point a light is
/// sampled and a direction is followed; where both can find the same light, the power heuristic
/// weighs them (Veach and Guibas, "Optimally combining sampling techniques for Monte Carlo
/// rendering", 1995). Paths end by Russian roulette alone.
///   start   on an opaque surface
///   bsdf    there, of the light that leaves against the ray that arrived
void trace_surface_path(const RayScene& rays, const trace::LightSampler& lights,
                        const trace::SurfacePoint& start, const trace::OpaqueBsdf& bsdf,
                        const trace::RandomStream& random, std::vector<PathLight>& found);

}  // namespace photile
