// Light from beyond the scene that rays can meet: surroundings, or the disc of a sun.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "photile/scene.hpp"
#include "trace/environment_sampler.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

/// What rays see of a light beyond the scene.
class DistantLight {
 public:
  /// References are kept.
  ///   share   of the light in its layer
  ///   radius  of the scene's bounding sphere, metres
  DistantLight(const Scene& scene, std::uint32_t light, double share, double radius);

  std::uint32_t light() const { return light_; }
  /// Radiance that arrives from a unit direction where the layer's power is 1.
  glm::vec3 radiance(const glm::vec3& direction) const;

 private:
  const Light* lamp_;
  const EnvironmentMap* map_ = nullptr;
  std::uint32_t light_;
  glm::vec3 factor_;  ///< radiance of the disc, or what the map's radiance is multiplied by
};

/// Those lights of the scene.
std::vector<DistantLight> distant_lights(const Scene& scene);

/// Whether a unit direction points into the disc of a directional light.
bool sees_disc(const Light& sun, const glm::vec3& direction);
/// Solid angle of the disc of a directional light, steradian.
double disc_solid_angle(const Light& sun);

/// Chooses directions towards a light beyond the scene, in proportion to its luminance.
class DistantSampler {
 public:
  /// References are kept. Surroundings are not black.
  DistantSampler(const Scene& scene, const Light& light);

  using Sample = EnvironmentSampler::Sample;
  Sample sample(const RandomBlock& random) const;
  /// Per steradian, of a unit direction.
  float density(const glm::vec3& direction) const;

 private:
  const Light* light_;
  std::optional<EnvironmentSampler> map_;
};

}  // namespace photile::trace
