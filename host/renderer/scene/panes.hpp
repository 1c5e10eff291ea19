// Panes: surfaces through which light passes straight on, whatever the file calls them. All code
// that looks for windows uses these functions.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "photile/scene.hpp"

namespace photile::scene {

/// What a pane lets straight through at normal incidence, per channel. Panes are thin glass, and
/// surfaces that are partly there all over, as glTF's alphaMode BLEND and MTL's d without an index
/// make them (IFC's glass is written so). None for other materials, and where textures say what is
/// there.
std::optional<glm::dvec3> pane_transmittance(const Material& material);

inline bool is_pane(const Material& material) { return pane_transmittance(material).has_value(); }

/// Whether windows are made of it: panes, and glass that bends light.
inline bool is_glazing(const Material& material) {
  return material.interaction == Interaction::glass || is_pane(material);
}

/// Makes a pane let through this fraction of light of any colour. What it reflects stays, or is as
/// much of its surface as is left.
///   transmittance   up to what thin glass without a tint lets through
void set_transmittance(Material& pane, double transmittance);

/// What a pane of glass reflects where each of its faces alone reflects `fresnel`: light bounces
/// between them, R = F + (1 - F)^2 F / (1 - F^2).
float pane_reflectance(float fresnel);

/// That of thin glass at normal incidence, as data sheets have it.
double glass_reflectance(const Material& glass);

/// Gives thin glass the index of refraction at which it reflects this fraction at normal incidence;
/// what it lets through stays. Returns false where the two would be more than there is.
bool set_glass_reflectance(Material& glass, double fraction);

}  // namespace photile::scene
