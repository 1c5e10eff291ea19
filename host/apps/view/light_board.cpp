#include "view/light_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "photile/errors.hpp"

namespace photile::view {
namespace {

/// Tints a light of the mix. Returns whether it can have that colour.
bool tint(LightMix& mix, const LightControl& control) {
  try {
    const std::string value =
        control.kelvin > 0 ? fmt::format("{:.6g}K", control.kelvin) : hex_of(*control.color);
    change_lights(mix, {{control.name, value}});
    return true;
  } catch (const UsageError&) {
    return false;
  }
}

}  // namespace

std::string hex_of(const glm::vec3& srgb) {
  const auto byte = [](float value) {
    return static_cast<int>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(srgb.r), byte(srgb.g), byte(srgb.b));
}

LightBoard::LightBoard(LightMix scene, std::shared_ptr<const MovingSky> sky)
    : scene_(std::move(scene)), sky_(std::move(sky)) {
  find_lights();
}

void LightBoard::find_lights() {
  lights_.clear();
  sky_name_ = "sky";
  std::vector<bool> of_sky(scene_.lights.size());
  if (sky_) {
    for (const std::size_t light : sky_->lights()) of_sky[light] = true;
  }
  for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
    if (!of_sky[i]) lights_.push_back(i);
  }
  const auto taken = [&](std::size_t light) { return scene_.lights[light].name == sky_name_; };
  while (std::any_of(lights_.begin(), lights_.end(), taken)) sky_name_ += "_";
  reset();
}

void LightBoard::reset() {
  controls_.clear();
  for (const std::size_t i : lights_) {
    const MixedLight& light = scene_.lights[i];
    LightControl control;
    control.name = light.name;
    control.members = light.members;
    control.unit = light.unit;
    control.power = control.scene_power = light.power;
    controls_.push_back(std::move(control));
  }
}

const LightControl* LightBoard::control_of(const std::string& name) const {
  const auto found =
      std::find_if(controls_.begin(), controls_.end(),
                   [&](const LightControl& control) { return control.name == name; });
  if (found != controls_.end()) return &*found;
  const auto gone = gone_.find(name);
  return gone == gone_.end() ? nullptr : &gone->second;
}

void LightBoard::adopt(LightMix scene, std::shared_ptr<const MovingSky> sky) {
  const LightBoard before = *this;
  for (const LightControl& control : controls_) gone_[control.name] = control;
  scene_ = std::move(scene);
  sky_ = std::move(sky);
  find_lights();
  take_settings(before);
}

void LightBoard::take_settings(const LightBoard& other) {
  daylight_ = other.daylight_;
  for (LightControl& control : controls_) {
    const LightControl* const its = other.control_of(control.name);
    if (!its || its->unit != control.unit) continue;
    const bool power_set = its->power != its->scene_power;
    control.power = power_set ? its->power : control.scene_power;
    control.on = its->on;
    control.solo = its->solo;
    control.color = its->color;
    control.kelvin = its->kelvin;
  }
}

bool LightBoard::sky_lit() const {
  return daylight_.on && std::none_of(controls_.begin(), controls_.end(),
                                      [](const LightControl& control) { return control.solo; });
}

LightMix LightBoard::lamps_mix() const {
  const bool any_solo = std::any_of(controls_.begin(), controls_.end(),
                                    [](const LightControl& control) { return control.solo; });
  LightMix result = scene_;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const LightControl& control = controls_[i];
    if (control.tinted()) tint(result, control);
    const bool lit = any_solo ? control.solo : control.on;
    result.lights[lights_[i]].power = lit ? control.power : 0;
  }
  return result;
}

LightMix LightBoard::mix() const {
  LightMix result = lamps_mix();
  if (!sky_) return result;
  const std::vector<double> powers = sky_->powers(daylight_.moment);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    result.lights[sky_->lights()[i]].power = sky_lit() ? powers[i] : 0;
  }
  return result;
}

LayerMixdown LightBoard::mixdown() const {
  LayerMixdown mixdown;
  mixdown.layer_of.resize(scene_.lights.size());
  mixdown.scale.assign(scene_.lights.size(), 1.0f);
  for (const std::size_t light : lights_) {
    mixdown.layer_of[light] = static_cast<std::uint32_t>(mixdown.layers.size());
    mixdown.layers.push_back(scene_.lights[light].name);
  }
  if (!sky_) return mixdown;
  const std::vector<double> powers = sky_->powers(daylight_.moment);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const std::size_t light = sky_->lights()[i];
    mixdown.layer_of[light] = static_cast<std::uint32_t>(mixdown.layers.size());
    mixdown.scale[light] = static_cast<float>(powers[i]);
  }
  mixdown.layers.push_back(sky_name_);
  return mixdown;
}

LightMix LightBoard::shown_mix() const {
  LightMix all = mix();
  if (!sky_) return all;
  LightMix shown;
  shown.lumen_per_watt = all.lumen_per_watt;
  for (const std::size_t light : lights_) shown.lights.push_back(std::move(all.lights[light]));
  MixedLight& sky = shown.lights.emplace_back();
  sky.name = sky_name_;
  sky.power = sky_lit() ? 1 : 0;
  sky.unit = all.lights[sky_->lights().front()].unit;
  return shown;
}

std::vector<std::string> LightBoard::refused() const {
  LightMix scratch = scene_;
  std::vector<std::string> names;
  for (const LightControl& control : controls_) {
    if (control.tinted() && !tint(scratch, control)) names.push_back(control.name);
  }
  return names;
}

}  // namespace photile::view
