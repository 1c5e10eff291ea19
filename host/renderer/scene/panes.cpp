#include "scene/panes.hpp"

#include <algorithm>
#include <cmath>

#include "photile/limits.hpp"
#include "scene/surface_models.hpp"

namespace photile::scene {

std::optional<glm::dvec3> pane_transmittance(const Material& material) {
  if (material.interaction == Interaction::glass) {
    if (!material.thin) return std::nullopt;
    return (1 - glass_reflectance(material)) * glm::dvec3(material.transmission);
  }
  const bool all_over = material.opacity_texture == none && material.opacity_cutoff <= 0.0f;
  if (!all_over || !(material.opacity < 1.0f)) return std::nullopt;
  return glm::dvec3(1 - double{material.opacity});
}

void set_transmittance(Material& pane, double transmittance) {
  if (pane.interaction == Interaction::glass) {
    pane.transmission =
        glm::vec3(static_cast<float>(transmittance / (1 - glass_reflectance(pane))));
  } else {
    pane.opacity = static_cast<float>(1 - transmittance);
  }
}

float pane_reflectance(float fresnel) { return 2.0f * fresnel / (1.0f + fresnel); }

double glass_reflectance(const Material& glass) {
  const double face = f0_from_index_of_refraction(double{glass.index_of_refraction});
  return double{pane_reflectance(static_cast<float>(face))};
}

bool set_glass_reflectance(Material& glass, double fraction) {
  if (!(fraction < 1)) return false;
  const glm::dvec3 transmission = *pane_transmittance(glass) / (1 - fraction);
  const double face = std::sqrt(fraction / (2 - fraction)), index = (1 + face) / (1 - face);
  if (std::max({transmission.r, transmission.g, transmission.b}) > 1 + 1e-6 ||
      index > limits::max_index_of_refraction) {
    return false;
  }
  glass.index_of_refraction = static_cast<float>(index);
  glass.transmission = glm::vec3(transmission);
  return true;
}

}  // namespace photile::scene
