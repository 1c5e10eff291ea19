// Next event estimation: the choice of a point on a light from a surface.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "photile/device/bsdf.h"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "trace/distant_light.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/light_clusters.hpp"
#include "trace/portals.hpp"
#include "trace/random_stream.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Light from one point of a light, as long as nothing is in the way.
struct LightSample {
  std::uint32_t layer;  ///< into LightGroups::groups
  glm::vec3 direction;  ///< unit, towards the light
  glm::vec3 target;     ///< where the shadow ray ends, metres
  /// The light that a surface receives per unit of its cosine: radiance / density, or, of lights
  /// without size, the illuminance of a surface that faces them. The layer's power is 1.
  glm::vec3 received;
  /// The density of the direction, per steradian, the choice of the light included. 0 for lights
  /// without size, which no other technique can find.
  float density;
  bool distant = false;        ///< from beyond the scene
  std::uint32_t light = none;  ///< one without size that is not beyond the scene

  /// Its weight beside a technique that finds its direction with density `other`, per steradian: 1
  /// where no other technique can.
  float weight_beside(float other) const {
    return density > 0.0f ? power_heuristic(density, other) : 1.0f;
  }
  /// Its weight where the light that a surface receives is bounded by that of its radiance from
  /// this many hemispheres; lights without size have the weight 1.
  float weight_below(float hemispheres) const {
    return density > 0.0f ? std::min(1.0f, hemispheres * PHOTILE_PI * density) : 1.0f;
  }
};

/// Chooses one light of all, half by power and half equally as PhotonQuota::balanced does, then a
/// point on an area light by its emission, or for light from beyond the scene a direction by its
/// luminance, or one through a portal towards whatever shines there; densities are those of both
/// together. Light samples of one point may prefer lights that are near it and face it.
class LightSampler {
 public:
  /// References are kept. Errors: InputError for an area light without area.
  explicit LightSampler(const Scene& scene);

  /// Selection probabilities of lights at a point of a surface, which take as long as two rays: for
  /// several samples. Lights that are sampled separately are not among them.
  ///   normal   unit, towards the side of the samples
  void weigh(const glm::vec3& position, const glm::vec3& normal,
             SelectionProbabilities& probabilities) const {
    probabilities.but_apart = true;
    clusters_.weigh(position, normal, probabilities);
    portals_.measure(glm::dvec3(position), probabilities.portals);
  }

  /// A sample of a light as seen from `position`. Nothing where no light from it arrives.
  ///   choice, on_light   separate blocks
  std::optional<LightSample> sample(
      const glm::vec3& position, const RandomBlock& choice, const RandomBlock& on_light,
      const SelectionProbabilities& probabilities = by_power_alone) const;

  /// Lights that need no random choice: those without size, for which one sample is exact, and suns
  /// (defaults::largest_sun); none where there are too many. If all lights are among them, none is
  /// left to choose by probabilities.
  const std::vector<std::uint32_t>& sampled_apart() const { return sampled_apart_; }
  bool samples_all_apart() const { return sampled_apart_.size() == fraction_.size(); }
  /// A sample of one of these as seen from `position`. Nothing where no light from it arrives.
  ///   on_disc   of a sun: its distance from the middle, squared, and the angle around it, both in
  ///             [0, 1)
  std::optional<LightSample> towards(std::uint32_t light, const glm::vec3& position,
                                     const glm::dvec2& on_disc = {}) const;

  /// Density per steradian with which `sample` would have chosen a point that emits, seen from
  /// `position`.
  float density(const glm::vec3& position, const SurfacePoint& emitting,
                const SelectionProbabilities& probabilities = by_power_alone) const;

  /// Lights beyond the scene that rays can hit, and the density per steradian with which `sample`
  /// would have chosen a direction towards one of them; infinite for those that are sampled
  /// separately, where the probabilities do not contain them: no other technique may find their
  /// light.
  const DistantLights& distant() const { return distant_; }
  float density(const DistantLight& light, const glm::vec3& position, const glm::vec3& direction,
                const SelectionProbabilities& probabilities = by_power_alone) const;

  /// Radiance that a point of an area light emits in a unit direction, at the power 1 of its layer.
  glm::vec3 radiance(const SurfacePoint& emitting, const glm::vec3& direction) const {
    return radiance_[scene_->triangle_light[emitting.where.triangle]] *
           emission_towards(*scene_, emitting, direction);
  }
  std::uint32_t layer(std::uint32_t light) const { return groups_.group_of[light]; }

 private:
  float probability(std::uint32_t light, const SelectionProbabilities& probabilities) const;
  std::optional<LightSample> towards_area(std::uint32_t light, SurfacePoint point,
                                          const glm::vec3& position,
                                          const SelectionProbabilities& probabilities) const;
  std::optional<LightSample> towards_light_without_size(std::uint32_t light,
                                                        const glm::vec3& position,
                                                        double probability) const;
  /// The apparent sizes of portals from a point.
  const PortalSizes& portals_from(const glm::vec3& position,
                                  const SelectionProbabilities& probabilities) const;
  /// A sample through a portal, towards what shines through it.
  ///   number   in [0, 1)
  std::optional<LightSample> through_portal(double number, const glm::vec3& position,
                                            const RandomBlock& on_light,
                                            const SelectionProbabilities& probabilities) const;
  LightSample towards_distant(std::uint32_t light, const glm::vec3& position,
                              const RandomBlock& on_light,
                              const SelectionProbabilities& probabilities) const;
  /// A point in that direction behind all of the scene, wherever the position is.
  glm::vec3 beyond(const glm::vec3& position, const glm::vec3& direction) const;

  const Scene* scene_;
  LightGroups groups_;
  BoundingSphere bounds_;
  std::vector<double> fraction_;  ///< of the light samples of any point, per light
  std::vector<std::uint32_t> sampled_apart_;
  LightClusters clusters_;
  std::vector<double> cumulative_fraction_;  ///< of the lights up to and including this one
  std::vector<glm::vec3> radiance_;          ///< per light, of white texels; black without area
  std::vector<std::uint32_t> area_of_;       ///< per light: its sampler, or `none`
  std::vector<AreaSampler> areas_;
  DistantLights distant_;
  Portals portals_;
  double portal_fraction_ = 0;  ///< of light samples that go through portals
  std::vector<DistantSampler> distant_samplers_;
  std::vector<std::uint32_t> distant_of_;  ///< per light: into both, or `none`
};

}  // namespace photile::trace
