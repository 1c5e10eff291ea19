// Panes: surfaces through which light passes straight on, whatever the file calls them. All code
// that looks for windows uses these functions.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "photile/scene.hpp"

namespace photile::scene {

/// The straight transmittance of a pane at normal incidence, per channel. Panes are thin glass, and
/// surfaces that are uniformly partly present, as with glTF's alphaMode BLEND and MTL's d without
/// an index (glass from IFC is written so). None for other materials, and where textures decide
/// what is present.
std::optional<glm::dvec3> pane_transmittance(const Material& material);

inline bool is_pane(const Material& material) { return pane_transmittance(material).has_value(); }

/// Whether windows are made of the material: panes, and glass that bends light.
inline bool is_glazing(const Material& material) {
  return material.interaction == Interaction::glass || is_pane(material);
}

/// Makes a pane transmit this fraction of light of any colour. Its reflection stays, or becomes
/// that of the remaining part of its surface.
///   transmittance   at most that of thin glass without a tint
void set_transmittance(Material& pane, double transmittance);

/// The reflectance of a pane of glass each of whose faces reflects `fresnel`: light bounces
/// between them, R = F + (1 - F)^2 F / (1 - F^2).
float pane_reflectance(float fresnel);

/// The reflectance of thin glass at normal incidence, as stated on data sheets.
double glass_reflectance(const Material& glass);

/// Gives thin glass the index of refraction at which it reflects this fraction at normal incidence;
/// its transmittance stays. Returns false where the two would sum to more than 1.
bool set_glass_reflectance(Material& glass, double fraction);

}  // namespace photile::scene
