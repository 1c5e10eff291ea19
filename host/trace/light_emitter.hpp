// Where the photons of a light start.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "photile/scene.hpp"
#include "trace/area_sampler.hpp"
#include "trace/random_stream.hpp"

namespace photile::trace {

struct EmittedRay {
  glm::vec3 origin;
  glm::vec3 direction;  ///< unit
};

/// Draws photon paths of one light so that each carries the same flux: area lights uniformly over
/// their area and with the cosine law; points uniformly over the sphere; spots by the falloff of
/// KHR_lights_punctual; directional lights uniformly over the disc of the scene's bounding sphere.
class LightEmitter {
 public:
  /// `scene` must outlive this; `bounds` is its bounding sphere, which only directional lights use.
  /// Errors: InputError for an area light without area.
  LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds);

  EmittedRay emit(const RandomStream& random) const;

 private:
  EmittedRay emit_from_area(const RandomStream& random) const;
  float spot_cosine(double u) const;

  const Scene* scene_;
  const Light* light_;
  std::optional<AreaSampler> area_;  ///< of area lights
  BoundingSphere bounds_;
};

}  // namespace photile::trace
