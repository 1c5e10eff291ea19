// What an opaque surface reflects but for one facet's reflection, as seen from one side
// (device/bsdf.h).
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

#include "photile/device/bsdf.h"
#include "scene/surface_models.hpp"

namespace photile::trace {

/// The three parts of photile_set_diffuse, each of all channels.
using DiffusePart = std::array<glm::vec3, 3>;

/// `n_dot_o`: cosine of the direction in which light leaves to the shading normal; the BSDF is
/// reciprocal but for normal maps, so that it may as well be the one in which light comes.
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

/// The share of light that the parts reflect in all directions, or of light from all directions,
/// per channel.
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

}  // namespace photile::trace
