#include <fmt/format.h>
#include <fnmatch.h>

#include <string_view>
#include <unordered_set>

#include "loading/finishing.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "scene/light_names.hpp"

namespace photile {

LightGrouping LightGrouping::parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(
        fmt::format("'{}' is no group of lights; use GLOB=NAME, such as 'ceiling*=ceiling'", text));
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

namespace loading {
namespace {

std::vector<std::string> names_of(const std::vector<Light>& lights) {
  std::vector<std::string> names;
  for (const Light& light : lights) names.push_back(light.name);
  return names;
}

void apply(const LightGrouping& grouping, std::vector<Light>& lights) {
  bool matched = false;
  for (Light& light : lights) {
    if (::fnmatch(grouping.glob.c_str(), light.name.c_str(), 0) != 0) continue;
    light.group = scene::clean_light_name(grouping.group, limits::max_light_name_bytes);
    matched = true;
  }
  if (!matched) {
    throw UsageError(fmt::format("light group {}={}: no light matches '{}'; there {}",
                                 grouping.glob, grouping.group, grouping.glob,
                                 scene::listed_names(names_of(lights))));
  }
}

/// Layers have names of their own.
void check_names(const std::vector<Light>& lights) {
  std::unordered_set<std::string_view> groups;
  for (const Light& light : lights) groups.insert(light.group);
  for (const Light& light : lights) {
    if (!light.group.empty() || !groups.contains(light.name)) continue;
    throw UsageError(
        fmt::format("light groups: the light '{}' is outside the group of that name; put it in or "
                    "choose another name",
                    light.name));
  }
}

}  // namespace

void group_lights(Scene& scene, std::span<const LightGrouping> groupings) {
  for (const LightGrouping& grouping : groupings) apply(grouping, scene.lights);
  check_names(scene.lights);
}

}  // namespace loading
}  // namespace photile
