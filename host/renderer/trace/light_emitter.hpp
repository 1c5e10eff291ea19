// Where the photons of a light start.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "photile/scene.hpp"
#include "trace/distant_light.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"
#include "trace/targets.hpp"

namespace photile::trace {

struct EmittedRay {
  glm::vec3 origin;
  glm::vec3 direction;  ///< unit
  glm::vec3 color;      ///< of the photon's flux, linear RGB; the mean of its luminance is 1
};

/// Draws photon paths of one light so that each carries the same flux: area lights over their area,
/// by its emission and with the cosine law; points uniformly over the sphere, or by their
/// intensities; spots by the falloff of KHR_lights_punctual; directional lights and environments by
/// the luminance of each direction, and uniformly over a disc of the scene's bounding sphere that
/// faces it. Where the scene has portals, most lines of the latter go through them, and each photon
/// carries its flux divided by the combined density of its line (the balance heuristic, Veach and
/// Guibas 1995): the expected result does not depend on the portals.
class LightEmitter {
 public:
  /// `scene` must outlive this; `bounds` is its bounding sphere, which only light from beyond uses.
  /// Errors: InputError for an area light without area.
  ///   portals   of the scene
  LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds,
               std::shared_ptr<const Portals> portals);
  LightEmitter(const Scene& scene, std::uint32_t light, const BoundingSphere& bounds)
      : LightEmitter(scene, light, bounds, std::make_shared<Portals>(scene)) {}

  EmittedRay emit(const RandomStream& random) const;

  /// Towards mirrors and glass only, which must exist: the same light arrives there as by `emit`,
  /// on more photons, each with its flux divided by the density of its ray relative to `emit`.
  EmittedRay emit_towards(const Targets& targets, const RandomStream& random,
                          const glm::dvec2& u) const;

 private:
  EmittedRay emit_from_area(const RandomStream& random) const;
  EmittedRay emit_from_luminaire(const RandomStream& random) const;
  EmittedRay emit_from_beyond(const RandomStream& random) const;
  EmittedRay emit_through_portals(const RandomStream& random) const;
  EmittedRay emit_from_area_towards(const Targets& targets, const RandomStream& random,
                                    const glm::dvec2& u) const;
  EmittedRay emit_from_beyond_towards(const Targets& targets, const RandomStream& random,
                                      const glm::dvec2& u) const;
  double flux_of_line(const glm::dvec3& travel, int entered) const;
  glm::vec3 color_of(const SurfacePoint& point) const;
  float spot_cosine(double u) const;

  const Scene* scene_;
  const Light* light_;
  std::optional<AreaSampler> area_;            ///< of area lights
  std::optional<IntensitySampler> intensity_;  ///< of lights with a distribution
  std::optional<DistantSampler> distant_;      ///< of environments and suns with a disc
  BoundingSphere bounds_;
  std::shared_ptr<const Portals> portals_;
  /// The fraction of photons that start through portals; 0 where the light reaches none.
  double portal_fraction_ = 0;
  std::optional<EnvironmentSampler> towards_portals_;  ///< of environments
};

}  // namespace photile::trace
