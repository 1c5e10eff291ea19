// The positions and directions in which photons leave a light: points of area lights by their
// emission, directions of lights without surface by their intensity.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <vector>

#include "photile/scene.hpp"
#include "scene/light_emission.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

class AreaSampler {
 public:
  /// References are kept. Errors: InputError for a light whose triangles have no area.
  AreaSampler(const Scene& scene, const Light& light);

  /// A point of the light: uniformly, or for a textured light about in proportion to its luminance.
  /// Uses all words.
  TriangleHit sample(const RandomBlock& random) const;
  /// A sample on the front of the surface.
  SurfacePoint sample_front(const RandomBlock& random) const;
  /// Uniformly on the front of triangle `number` of the light, which has no texture.
  SurfacePoint sample_front_of(std::size_t number, const RandomBlock& random) const;
  /// The density of `sample` at a point of the light, per square metre of one side.
  double density(const TriangleHit& where) const;

 private:
  /// The part of `surface_point` that is the same for all points of a triangle.
  struct Front {
    glm::dvec3 corner, along_u, along_v;
    glm::vec3 normal;
    float ray_offset;
    std::uint32_t side;
  };
  std::size_t chosen(const RandomBlock& random) const;

  const Scene* scene_;
  const Light* light_;
  std::vector<Front> fronts_;       ///< of the triangles; none of a textured light
  std::vector<double> area_up_to_;  ///< area of the triangles up to and including this one
  std::optional<scene::EmissionCells> cells_;  ///< of a textured light
};

/// The cone of a spot light (KHR_lights_punctual): over t = cosine - outer its intensity is
/// (t / edge)^2 up to the edge of the inner cone, then 1.
struct SpotFalloff {
  explicit SpotFalloff(const Light& light)
      : outer(std::cos(static_cast<double>(light.outer_cone_angle))),
        edge(std::cos(static_cast<double>(light.inner_cone_angle)) - outer) {}

  /// Intensity, 1 in the inner cone, in a direction at `cosine` to the axis.
  double at(double cosine) const {
    const double t = cosine - outer;
    if (t <= 0) return 0;
    return t < edge ? (t / edge) * (t / edge) : 1;
  }
  /// The integral of the intensity over the cosine; times 2 pi it is the flux.
  double integral() const { return edge / 3.0 + 1.0 - (outer + edge); }

  double outer;  ///< cosine
  double edge;   ///< cosine of the inner cone less that of the outer one
};

/// The axes of a light, which shines along the -z axis of its space.
struct LightAxes {
  explicit LightAxes(const Light& light)
      : x(light.x_axis), z(-glm::dvec3(light.direction)), y(glm::cross(z, x)) {}

  glm::dvec3 to_world(const glm::dvec3& v) const { return x * v.x + y * v.y + z * v.z; }
  glm::dvec3 to_light(const glm::dvec3& v) const {
    return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
  }

  glm::dvec3 x, z, y;  ///< unit; y needs the others
};

/// Candela of a point or spot light in a unit direction, away from it, for each lumen that it
/// emits.
inline double candela_per_lumen(const Scene& scene, const Light& light,
                                const glm::dvec3& direction) {
  if (light.distribution != none) {
    const IntensityDistribution& distribution = scene.distributions[light.distribution];
    return distribution.intensity(LightAxes(light).to_light(direction)) / distribution.flux();
  }
  if (light.kind == LightKind::spot) {
    const SpotFalloff spot(light);
    return spot.at(glm::dot(direction, glm::dvec3(light.direction))) /
           (glm::two_pi<double>() * spot.integral());
  }
  return 0.25 * glm::one_over_pi<double>();
}

/// Directions of photons from a light whose intensities were measured.
class IntensitySampler {
 public:
  /// References are kept. `light` has a distribution that emits something.
  IntensitySampler(const Scene& scene, const Light& light);

  /// A direction in the scene, density intensity / flux: a cell of the grid by its flux, and in it
  /// a direction by rejection, which takes at most 4 tries on average.
  glm::vec3 sample(const RandomStream& random) const;

 private:
  const IntensityDistribution* distribution_;
  LightAxes axes_;
  std::vector<double> flux_up_to_;  ///< of the cells up to and including this one, column by column
};

}  // namespace photile::trace
