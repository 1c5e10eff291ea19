// Light that reaches a surface directly from lights, by rays instead of photons.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "photile/ray_scene.hpp"
#include "trace/light_sampler.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// Light of one layer, whose power is 1, at a shading point.
struct ReceivedLight {
  std::uint32_t layer;   ///< into LightGroups::groups
  glm::vec3 irradiance;  ///< lm/m2
  glm::vec3 radiance;    ///< reflected against the ray that arrived at the shading point
};

/// Random numbers for a light sample.
struct LightNumbers {
  RandomBlock choice, position;  ///< which light, and where on it
};

/// The positions in scrambled sequences (random_stream.hpp) of the light samples of a shading
/// point: point `first` and those after it.
class LightSampleNumbers {
 public:
  /// `sequences`: shading points that share them, such as the samples of a pixel, each use
  /// different points of them.
  ///   surface   of a path, counted from 0: each has its own sequences
  LightSampleNumbers(const RandomStream& sequences, std::uint32_t first, std::uint32_t surface = 0);

  /// Random numbers of one light sample, and of one direction chosen by the shading point.
  struct Sample : LightNumbers {
    RandomBlock lobe, direction;  ///< of the shading point
  };
  Sample sample(std::uint32_t number) const;
  /// Only the numbers for the light.
  LightNumbers light(std::uint32_t number) const;

 private:
  std::array<RandomBlock, 4> scrambles_;  ///< of pairs of dimensions
  std::uint32_t first_;
};

/// The part of a surface's reflection that is requested.
enum class ReflectedPart : std::uint8_t {
  all,
  but_the_base,  ///< OpaqueBsdf::drop_diffuse
  but_the_lobe   ///< OpaqueBsdf::drop_lobe
};

/// Estimates the direct light at a point of an opaque surface, or through panes of thin
/// glass and cutouts: exactly the light of photons that have not been scattered. `count` times a
/// light is sampled, and a direction drawn from the surface's reflection is followed; what both
/// would find is weighted (Veach and Guibas 1995, power heuristic). The sum over what is appended
/// to `found` is unbiased.
///   direction   of the ray that arrived at the point, unit
///   part        of the reflection that counts in the radiance
void find_direct_light(const RayScene& rays, const LightSampler& light_sampler,
                       const SurfacePoint& point, const glm::vec3& direction, ReflectedPart part,
                       int count, const LightSampleNumbers& samples,
                       std::vector<ReceivedLight>& found);

/// Light samples from surfaces that lie close together, for irradiance: the part that light samples
/// find where directions with the density of the cosine are followed as well. Shadow rays are
/// traced sixteen at a time.
class ShadowRays {
 public:
  void clear();

  /// Takes one light sample.
  ///   weight       of what the light sample finds
  ///   directions   followed for each light sample; what both would find is weighted
  ///   tag          that is returned with the light
  void add(const SurfacePoint& point, const std::optional<LightSample>& light,
           const glm::vec3& weight, float directions, std::uint32_t tag);

  struct Found {
    std::uint32_t tag, layer;
    glm::vec3 irradiance;  ///< weighted, lm/m2
    glm::vec3 direction;   ///< towards the light, unit
  };
  /// The light samples that nothing occludes, in their order.
  std::span<const Found> found(const RayScene& rays);

  /// The light of a sun that is sampled separately, without weights; none where all of it is
  /// hidden. It is sampled in the same directions from all points, in more directions where a part
  /// of it is hidden: so neighbours do not differ at random, and the dark beside the border of its
  /// light stays dark. Clears all samples.
  std::optional<Found> light_of_sun(std::uint32_t light, const RayScene& rays,
                                    const LightSampler& light_sampler, const SurfacePoint& point);

 private:
  std::vector<LineOfSight> lines_;
  std::vector<RayOrigin> origins_;  ///< one for each line
  std::vector<Found> found_;        ///< one for each line
  std::vector<std::uint8_t> hidden_;
};

}  // namespace photile::trace
