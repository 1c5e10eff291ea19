#include <utility>

#include "photile/layered_picture.hpp"

namespace photile {

LightMix LightMix::of(const Scene& scene, double lumen_per_watt) {
  LightMix mix;
  mix.lumen_per_watt = lumen_per_watt;
  for (const LightGroup& group : light_groups_of(scene).groups) {
    MixedLight mixed;
    mixed.name = group.name;
    mixed.power = group.power;
    mixed.unit = scene.unit;
    mixed.color = group.color;
    for (const std::uint32_t light : group.lights) {
      if (!scene.lights[light].group.empty()) mixed.members.push_back(scene.lights[light].name);
    }
    mix.lights.push_back(std::move(mixed));
  }
  return mix;
}

}  // namespace photile
