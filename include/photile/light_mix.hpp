// Relighting: the powers and colours of lights, applied to their layers.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "photile/image.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"

namespace photile {

/// State of one light, or of a group of lights, in a mix.
struct MixedLight {
  std::string name;
  std::vector<std::string> members;  ///< lights of a group; empty for a light alone
  double power = 0;                  ///< in `unit`
  PowerUnit unit = PowerUnit::lumen;
  glm::vec3 color{1.0f};  ///< the light's own colour, as its photons carried it; luminance 1
  /// Multiplies the layer, on top of `color`. Scaled so that luminance(tint * color) = 1: a tinted
  /// light emits `power` as before and keeps its direct illuminance. What it gives by reflection
  /// from coloured surfaces changes, which one plane of illuminance cannot follow.
  glm::vec3 tint{1.0f};
};

struct LightMix {
  std::vector<MixedLight> lights;
  double lumen_per_watt = 683;

  /// The scene's own powers.
  static LightMix of(const Scene& scene, double lumen_per_watt);
};

/// A change asked for on the command line: NAME=POWER[lm|W] | NAME=xFACTOR | NAME=#RRGGBB |
/// NAME=KELVINK | NAME=off. POWER is in the light's own unit unless it names one; #RRGGBB is sRGB,
/// of which only the hue and saturation count. Several changes of one light apply in order.
struct LightChange {
  std::string name;
  std::string value;
  /// Splits at the last '=', so that names may hold one. Errors: UsageError when `text` has no '='
  /// or an empty side.
  static LightChange parse(const std::string& text);
};

/// Applies changes. Errors: UsageError for an unknown light (the message lists those there are), a
/// negative or non-finite power, a malformed value, a colour that the light does not emit.
void change_lights(LightMix& mix, const std::vector<LightChange>& changes);

/// Layers x powers, as channels: root R G B A (the sum, alpha 1), `Combined_<light>.R/G/B` and
/// `Illuminance_<light>.Y` in lux, with attribute `photile.lights` (JSON) and units. The root is
/// the float sum of the layers in order. Errors: UsageError when the mix lacks a layer's light.
Image mix_layers(const LightLayers& layers, const LightMix& mix);

/// The root of mix_layers alone, bit for bit, for live relighting: `picture` (width x height,
/// linear RGB) is overwritten with the sum of layers x powers. Work is shared by TBB. Errors:
/// UsageError when the mix lacks a layer's light, or `picture` has another size.
void combine_layers(const LightLayers& layers, const LightMix& mix, std::span<glm::vec3> picture);

/// Changes powers from a picture alone. Reads layers named `Combined_<light>`, Blender's
/// `ViewLayer.Combined_<light>`, Arnold's `RGBA_<light>`; powers from `photile.lights` where the
/// file has it, else every light has power 1 and only factors, colours and "off" are accepted.
/// Returns the channels of `mix_layers`: the root is the sum of the layers, so light that another
/// program left out of every layer is not in it. The root's alpha and the attributes are kept.
/// Errors: InputError when the picture has no light layers, several views of them, or damaged
/// records; UsageError as in `change_lights`; UsageError when a light that is off in the picture,
/// or a colour that it lacks there, is to be turned up.
Image relight(const Image& layered, const std::vector<LightChange>& changes);

/// The layers of a picture at a power of 1, for combine_layers with relit_mix: to change lights as
/// often as a slider moves. A light that is off in the picture, or lacks a colour there, is black.
/// Errors: InputError as `relight`.
LightLayers light_layers(const Image& layered);

/// The lights of a picture after changes, with the refusals of `relight`.
LightMix relit_mix(const PictureHeader& layered, const std::vector<LightChange>& changes);

/// The lights of a picture, as `relight` sees them. Errors: InputError as `relight`, naming the
/// file.
LightMix read_light_mix(const PictureHeader& layered);
LightMix read_light_mix(const std::filesystem::path& file);

}  // namespace photile
