// The BSDF of an opaque surface (device/bsdf.h) at one point, for the ray that arrives there: its
// value, directions drawn from it, and their density.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "photile/device/bsdf.h"
#include "scene/surface_models.hpp"
#include "trace/random_stream.hpp"
#include "trace/sampling.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

/// The three parts of photile_set_diffuse, each of all channels.
using DiffusePart = std::array<glm::vec3, 3>;

/// `n_dot_o`: cosine of the direction in which light leaves to the shading normal; the BSDF is
/// reciprocal without normal maps, so that it may also be the direction in which light comes.
inline DiffusePart diffuse_part(const scene::Reflectance& surface, float n_dot_o) {
  PhotileAlbedoFit fit;
  photile_albedo_fit(surface.alpha, &fit);
  float o[2], mean[2];
  photile_lobe_albedo(&fit, n_dot_o, &o[0], &o[1]);
  photile_mean_lobe_albedo(surface.alpha, &mean[0], &mean[1]);
  DiffusePart result;
  for (int c = 0; c < 3; ++c) {
    float part[3];
    photile_set_diffuse(surface.albedo[c], surface.f0[c], surface.f90, o, mean, part);
    for (std::size_t i = 0; i < 3; ++i) result[i][c] = part[i];
  }
  return result;
}

/// The fraction of light that the parts reflect into, or from, all directions, per channel.
inline glm::vec3 diffuse_reflectance(const DiffusePart& part, float alpha) {
  float f0_weight = 0, f90_weight = 0;
  photile_mean_lobe_albedo(alpha, &f0_weight, &f90_weight);
  return glm::max(PHOTILE_PI * (part[0] + f0_weight * part[1] + f90_weight * part[2]),
                  glm::vec3(0.0f));
}

/// `most` of photile_bump_weight for a surface that reflects up to this.
inline float most_bump(const glm::vec3& reflectance) {
  return 1.0f / std::clamp(std::max({reflectance.r, reflectance.g, reflectance.b}), 1e-3f, 1.0f);
}

/// Where the rays of a path come from. With a normal map the BSDF is not reciprocal.
enum class PathStart : std::uint8_t { eye, light };

/// Directions are unit and point away from the surface. Cosines are those to the geometric normal,
/// as in the radiance estimate; the lobe turns with the shading normal, and a normal map weights
/// light by its cosine to the mapped one. The base of a surface without a normal map may be made to
/// weight light by its cosine to the interpolated normal.
class OpaqueBsdf {
 public:
  /// `direction`: of the ray that arrives at the point, unit.
  OpaqueBsdf(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction,
             PathStart start = PathStart::eye);

  /// Lets the base weight light by its cosine to the shading normal, for rays from the eye: light
  /// between surfaces uses the geometric one, so that none is lost or created. Light from below the
  /// geometric surface does not count in either case. Does nothing where there is a normal map.
  void shade_smoothly(const Scene& scene, const SurfacePoint& point);

  /// Leaves the reflection of the base out; directions are drawn as before.
  void drop_diffuse();

  /// Leaves all but the reflection of one facet out: directions are those of the lobe.
  void keep_lobe();

  /// Leaves the reflection of one facet out; directions follow the cosine.
  void drop_lobe();

  /// Spreads what one facet reflects over directions as wide as those of this alpha, at least.
  void widen_lobe(float least_alpha);

  /// Whether rays find what the lobe reflects better than photons do: it is narrow, or reflects
  /// little.
  bool lobe_suits_rays() const;

  /// The mean number of rays by which to follow the lobe of one sample: less than one where it
  /// reflects little or hardly scatters, more where it reflects all light, from many directions.
  double lobe_rays() const;

  /// Fraction of the directions drawn from the lobe, in [0, 1]: about its part of reflected light.
  float lobe_fraction() const { return lobe_ ? lobe_->fraction : 0.0f; }

  /// Fraction of light from all sides that is reflected, without one facet's reflection.
  glm::vec3 base_reflectance() const;

  /// Fraction of light from all sides that one facet reflects towards the eye.
  glm::vec3 lobe_reflectance() const;

  /// The reflection, without that of one facet, in a direction, f x cosine per steradian, minus its
  /// mean over all directions: a coat lets less through at grazing angles.
  glm::vec3 base_deviation(const glm::vec3& direction) const;

  /// Whether it is a Lambertian lobe about the geometric normal, and nothing else.
  bool lambertian() const { return !lobe_ && base_normal_ == normal_; }

  /// Whether it is more than a Lambertian lobe.
  bool glossy() const { return lobe_.has_value(); }
  const glm::vec3& albedo() const { return surface_.albedo; }  ///< of the Lambertian lobe

  /// A direction from the Lambertian or the GGX lobe, picked in proportion to estimates of their
  /// albedos. Nothing where it would enter the surface. Uses the words `choice_word`,
  /// `direction_word` and the one after it.
  std::optional<glm::vec3> sample(const RandomBlock& random) const;

  /// Density of such directions per steradian; 0 below the surface.
  float density(const glm::vec3& direction) const;

  /// f x cosine, per steradian; black below the surface.
  glm::vec3 reflected(const glm::vec3& direction) const;

 private:
  struct Lobe {
    Frame frame;           ///< of the shading normal
    glm::vec3 view{0.0f};  ///< against the ray that arrived, in `frame`
    float n_dot_view = 0;  ///< kept above 0
    PhotileAlbedoFit fit{};
    DiffusePart diffuse{};
    float albedo = 0;     ///< of one facet's reflection, of the channel that reflects most
    float fraction = 0;   ///< of the directions drawn, in [0, 1]
    bool mapped = false;  ///< there is a normal map
    glm::vec3 smooth_normal{0.0f};
  };
  /// The factor of a normal map on f at a direction in the frame of the lobe.
  float bump_at(const glm::vec3& out) const;
  Lobe lobe_of(const Scene& scene, const SurfacePoint& point, const glm::vec3& direction) const;

  scene::Reflectance surface_;
  glm::vec3 normal_;
  glm::vec3 base_normal_;  ///< by which the base weights light
  PathStart start_;
  std::optional<Lobe> lobe_;  ///< none where the surface is Lambertian
};

/// A microfacet normal as seen from unit direction `view` (view.z > 0), both in the frame of the
/// shading normal (Heitz, "Sampling the GGX distribution of visible normals", JCGT 2018). Its
/// density is G1 (view.normal) D / view.z per steradian.
glm::vec3 sample_ggx_visible_normal(const glm::vec3& view, float alpha, float u1, float u2);

/// Density per steradian of directions reflected about such a normal: G1 D / (4 n.view).
float ggx_reflection_density(float n_dot_view, float n_dot_half, float alpha);

}  // namespace photile::trace
