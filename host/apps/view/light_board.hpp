// The lamps as the viewer sets them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "view/moving_sky.hpp"

namespace photile::view {

/// A light, or a group of lights under one slider.
struct LightControl {
  std::string name;
  std::vector<std::string> members;  ///< lights of a group; empty for a light alone
  PowerUnit unit = PowerUnit::lumen;
  double power = 0;        ///< in `unit`, when it is on
  double scene_power = 0;  ///< what the scene says
  bool on = true;
  bool solo = false;
  std::optional<glm::vec3> color;  ///< sRGB in [0, 1] that tints it; none = the light's own
  double kelvin = 0;               ///< temperature of its colour, in place of `color`; 0 = none

  bool tinted() const { return color || kelvin > 0; }
};

/// One control per light, or group, of the scene; a sky that hours move has one moment for all its
/// patches. Changing one costs a sum over layers or nodes, no light is traced again.
class LightBoard {
 public:
  ///   sky   whose patches lights of the scene are; null = none
  explicit LightBoard(LightMix scene, std::shared_ptr<const MovingSky> sky = nullptr);

  std::vector<LightControl>& controls() { return controls_; }
  const std::vector<LightControl>& controls() const { return controls_; }

  /// The moment of the sky, where there is one.
  struct Daylight {
    SkyMoment moment;
    bool on = true;
  };
  Daylight& daylight() { return daylight_; }
  const Daylight& daylight() const { return daylight_; }
  const MovingSky* sky() const { return sky_.get(); }

  /// What the controls make of the scene's lights. While one or more are solo, the others are dark.
  /// A colour that a light cannot have (it has none of a primary) leaves it as it was: see
  /// `refused`.
  LightMix mix() const;
  /// The mix with the lights of the sky as the scene has them.
  LightMix lamps_mix() const;

  /// How frames' layers are made of the scene's: the patches of the sky are one, at the powers of
  /// the moment.
  LayerMixdown mixdown() const;
  /// `mix` of these layers.
  LightMix shown_mix() const;

  double lumen_per_watt() const { return scene_.lumen_per_watt; }

  /// Names of lights whose colour `mix` could not set, for the panel to show.
  std::vector<std::string> refused() const;

  /// Resets all controls to the scene's values.
  void reset();

  /// Continues with a scene of other lights. Settings stay with the lights' names; those of lights
  /// that are gone are kept for their return. Lights whose power was not set take the scene's.
  void adopt(LightMix scene, std::shared_ptr<const MovingSky> sky);
  /// The settings of another board, by name.
  void take_settings(const LightBoard& other);

 private:
  void find_lights();
  const LightControl* control_of(const std::string& name) const;
  bool sky_lit() const;

  LightMix scene_;
  std::shared_ptr<const MovingSky> sky_;
  std::string sky_name_;             ///< of its layer
  std::vector<std::size_t> lights_;  ///< of the controls: into the scene's
  std::vector<LightControl> controls_;
  std::map<std::string, LightControl> gone_;  ///< of lights that the scene had before
  Daylight daylight_;
};

/// "#rrggbb" of an sRGB colour in [0, 1].
std::string hex_of(const glm::vec3& srgb);

}  // namespace photile::view
