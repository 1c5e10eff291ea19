// Light that reaches a surface straight from lamps, by rays instead of photons.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"
#include "trace/random_stream.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Light of one layer, whose power is 1, at a receiver.
struct ReceivedLight {
  std::uint32_t layer;   ///< into LightGroups::groups
  glm::vec3 irradiance;  ///< lm/m2
  glm::vec3 radiance;    ///< reflected against the ray that arrived at the receiver
};

/// The places of scrambled sequences (sobol.hpp) that a receiver's looks take: point `first` and
/// those after it.
class LookSamples {
 public:
  /// `sequences`: receivers that share them, as the samples of a pixel do, take others of their
  /// points each.
  ///   surface   of a path, counted from 0: each has sequences of its own
  LookSamples(const RandomStream& sequences, std::uint32_t first, std::uint32_t surface = 0);

  /// Random numbers of one look. All words of a block may be used; the blocks of a direction and
  /// of a lamp share some, so that no estimate may multiply what is found by both.
  struct Look {
    RandomBlock lamp, place;      ///< which lamp, and where on it
    RandomBlock lobe, direction;  ///< of the receiver
  };
  Look look(std::uint32_t number) const;

 private:
  std::array<RandomBlock, 4> scrambles_;  ///< of pairs of dimensions
  std::uint32_t first_;
};

/// What of a surface's reflection is wanted.
enum class ReflectedPart : std::uint8_t {
  all,
  but_the_base,  ///< OpaqueBsdf::drop_diffuse
  but_the_lobe   ///< OpaqueBsdf::drop_lobe
};

/// Estimates what lamps send straight to a point of an opaque surface, or through panes of thin
/// glass and holes of cut-out surfaces: just what photons bring that are not scattered before.
/// `count` times a lamp is looked at, and a direction of the surface's own is followed; what both
/// would find is weighed (Veach and Guibas 1995, power heuristic). The sum over what is appended to
/// `found` is unbiased.
///   direction   of the ray that arrived at the point, unit
///   part        of the reflection that the radiance has
void find_direct_light(const RayScene& rays, const LightSampler& lamps, const SurfacePoint& point,
                       const glm::vec3& direction, ReflectedPart part, int count,
                       const LookSamples& samples, std::vector<ReceivedLight>& found);

/// The part of the irradiance that looks at lamps find where directions with the density of the
/// cosine are followed as well: both together are what find_direct_light finds.
///   directions   followed for each look; what both would find is weighed
///   chances      of lamps at the point
void look_at_lamps(const RayScene& rays, const LightSampler& lamps, const SurfacePoint& point,
                   int count, float directions, const LookSamples& samples,
                   const LampChances& chances, std::vector<ReceivedLight>& found);

}  // namespace photile::trace
