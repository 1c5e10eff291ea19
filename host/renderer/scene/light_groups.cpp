#include <map>
#include <string_view>

#include "photile/light_layers.hpp"

namespace photile {
namespace {

/// Gathers the lights of each layer.
LightGroups gathered(const std::vector<Light>& lights) {
  LightGroups result;
  std::map<std::string_view, std::uint32_t> named;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    auto group = static_cast<std::uint32_t>(result.groups.size());
    if (!light.group.empty()) group = named.try_emplace(light.group, group).first->second;
    if (group == result.groups.size()) {
      result.groups.emplace_back().name = light.group.empty() ? light.name : light.group;
    }
    result.groups[group].lights.push_back(i);
    result.groups[group].power += light.power;
    result.group_of.push_back(group);
  }
  return result;
}

}  // namespace

LightGroups light_groups_of(const Scene& scene) {
  LightGroups result = gathered(scene.lights);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    LightGroup& group = result.groups[result.group_of[i]];
    const double share = group.power > 0 ? scene.lights[i].power / group.power
                                         : 1.0 / static_cast<double>(group.lights.size());
    group.color += glm::vec3(share * glm::dvec3(scene.lights[i].color));
    result.share.push_back(share);
  }
  return result;
}

}  // namespace photile
