// Rays from points of surfaces in all directions, by the cosine, for indirect irradiance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/eye_path.hpp"
#include "trace/targets.hpp"

namespace photile::trace {

struct HemisphereParameters {
  int batches;  ///< of a point: independent of each other
  int rays;     ///< of a batch: spread evenly (random_stream.hpp)
  /// Rays of the batch before these; together they are spread evenly.
  std::uint32_t first_ray = 0;
  std::uint64_t seed;
  int max_specular_depth;  ///< mirrors and glass that a ray follows
  const LightSampler* light_sampler;
  const std::vector<glm::vec3>* emitted_radiance;  ///< per light, at power 1
  /// > 0: rays also see the lights that they hit directly or through panes, and light samples find
  /// the same: weighted by the power heuristic. 0 = they see no lights.
  float rays_per_light_sample = 0;
  /// Surface nearer than this, metres, does not end a ray: one more light sample and one more ray
  /// find the light that falls there, a few times in succession. 0 = all opaque surface ends rays.
  float near = 0;
  /// Where `near` is not 0: 1 for each oriented face that does not end rays either, however far it
  /// is; empty = none.
  std::span<const std::uint8_t> slats = {};
  /// Targets of the fraction `defaults::rays_to_bright` of the rays; null or empty = none.
  const Targets* bright = nullptr;
};

/// Rays of a run of points that end on an opaque surface, in the order point, batch, ray.
struct HemisphereRays {
  /// Where they end. `pixel` is the ray: (point of the run x batches + batch) x rays + ray.
  /// `throughput` is such that throughput x radiance, summed over a point's batch, is an unbiased
  /// estimate of the irradiance that other surfaces send there directly or over mirrors and glass.
  /// `emission` is the same for lights, weighted. `direct` is the light that lights send to near
  /// surface, by layer.
  EyeRecord ray_hits;
  /// Point i of the run has [first[i], first[i + 1]): ray hits, lights that its rays hit, and light
  /// that reached near surface.
  std::vector<std::size_t> first, first_emission, first_direct;
  /// The direction in which each ray left its point, unit, by its number (`pixel`); empty unless
  /// the scene has smooth shading.
  std::vector<glm::vec3> direction;
  /// Per point: sum of the inverse distances to the surfaces that rays hit first, 1/m.
  std::vector<float> inverse_distances;

  /// The direction of a ray, or 0 where directions are not kept.
  glm::vec3 direction_of(std::uint32_t ray) const {
    return direction.empty() ? glm::vec3(0.0f) : direction[ray];
  }
};

/// The reflection of a hit's surface towards its ray under light that is the same from everywhere.
struct HitReflection {
  glm::vec3 reflectance;
  bool strong_lobe;  ///< its lobe reflects so much that the direction of light matters
};
HitReflection reflection_of(const EyeRecord& ray_hits, std::size_t hit);

/// Traces rays with the density of the cosine to the geometric normal, or with that of a mix of it
/// and of directions to bright surface, through cutouts, mirrors and glass to the next opaque
/// surface. Lights in mirrors or behind glass that bends are not seen:
/// their light is a caustic.
/// Depends on the scene, each point, its number and the parameters only.
///   number   of each point, below 2^48: the same number and point give the same rays
HemisphereRays trace_hemispheres(const RayScene& rays, const PrimaryHits& points, std::size_t first,
                                 std::size_t count, std::span<const std::uint64_t> number,
                                 const HemisphereParameters& parameters);

}  // namespace photile::trace
