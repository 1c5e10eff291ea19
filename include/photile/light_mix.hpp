// Relighting: the powers and colours of lights, applied to their layers.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "photile/image.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"

namespace photile {

/// State of one light in a mix.
struct MixedLight {
  std::string name;
  double power = 0;        ///< in `unit`
  PowerUnit unit = PowerUnit::lumen;
  glm::vec3 tint{1.0f};    ///< multiplies the layer, on top of the light's own colour
};

struct LightMix {
  std::vector<MixedLight> lights;
  double lumen_per_watt = 683;

  /// The scene's own powers.
  static LightMix of(const Scene& scene, double lumen_per_watt);
};

/// A change asked for on the command line: NAME=POWER[lm|W] | NAME=xFACTOR | NAME=#RRGGBB | NAME=off.
/// Several changes of one light apply in order.
struct LightChange {
  std::string name;
  std::string value;
  /// Errors: UsageError when `text` has no '=' or an empty side.
  static LightChange parse(const std::string& text);
};

/// Applies changes. Errors: UsageError for an unknown light (the message lists those there are), a
/// negative or non-finite power, a malformed value.
void apply(LightMix& mix, const std::vector<LightChange>& changes);

/// Layers x powers, as channels: root R G B A (the sum, alpha 1), `Combined_<light>.R/G/B` and
/// `Illuminance_<light>.Y` in lux, with attribute `photile.lights` (JSON) and units. The root is the
/// float sum of the layers in order.
Image mix_layers(const LightLayers& layers, const LightMix& mix);

/// Changes powers from a picture alone. Reads layers named `Combined_<light>`, Blender's
/// `ViewLayer.Combined_<light>`, Arnold's `RGBA_<light>`; powers from `photile.lights` where the
/// file has it, else every light has power 1 and only factors, colours and "off" are accepted.
/// Errors: InputError when the picture has no light layers; UsageError as in `apply`; UsageError
/// when a light that is off in the picture is to be turned up.
Image relight(const Image& layered, const std::vector<LightChange>& changes);

/// The lights of a picture, as `relight` sees them.
LightMix read_light_mix(const Image& layered);

}  // namespace photile
