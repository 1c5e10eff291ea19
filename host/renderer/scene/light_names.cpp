#include "scene/light_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <unordered_set>

#include "common/ascii_text.hpp"
#include "common/foreign_text.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"

namespace photile::scene {

std::string clean_light_name(std::string_view name, std::size_t max_bytes) {
  std::string clean;
  while (!name.empty()) {
    const std::size_t length = utf8_sequence_length(name);
    const std::size_t consumed = std::max<std::size_t>(length, 1);
    if (clean.size() + consumed > max_bytes) break;
    const auto first = static_cast<unsigned char>(name[0]);
    const bool kept = length > 1 || (length == 1 && (std::isalnum(first) || first == '-'));
    clean += kept ? name.substr(0, length) : std::string_view("_");
    name.remove_prefix(consumed);
  }
  return clean.empty() ? std::string("light").substr(0, max_bytes) : clean;
}

std::string unused_light_name(std::string_view name, std::unordered_set<std::string>& taken) {
  std::string result = clean_light_name(name, limits::max_light_name_bytes);
  for (int number = 2; !taken.insert(result).second; ++number) {
    const std::string suffix = fmt::format("_{}", number);
    result = clean_light_name(name, limits::max_light_name_bytes - suffix.size()) + suffix;
  }
  return result;
}

void make_light_names_unique(std::vector<Light>& lights) {
  std::unordered_set<std::string> taken, groups;
  std::map<std::string, std::string> group_named;  // by the name as given
  for (Light& light : lights) {
    if (light.group.empty()) continue;
    const auto [known, is_new] = group_named.try_emplace(light.group);
    if (is_new) known->second = unused_light_name(light.group, groups);
    light.group = known->second;
  }
  const auto take = [&](const Light& light) {
    return !(light.group.empty() && groups.contains(light.name)) && taken.insert(light.name).second;
  };
  for (Light& light : lights) {
    const std::string original = light.name;
    light.name = clean_light_name(original, limits::max_light_name_bytes);
    for (int number = 2; !take(light); ++number) {
      const std::string suffix = fmt::format("_{}", number);
      light.name =
          clean_light_name(original, limits::max_light_name_bytes - suffix.size()) + suffix;
    }
  }
}

std::string names_like(std::string_view name, std::vector<std::string> names, std::size_t most) {
  const std::string requested = lower(name);
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return edits_between(requested, lower(a)) < edits_between(requested, lower(b));
  });
  return listed_names(names, most);
}

std::string listed_names(std::span<const std::string> names, std::size_t most) {
  if (names.empty()) return "are none";
  std::string list = names.size() == 1 ? "is " : "are ";
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) {
    list += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  }
  if (names.size() > most) list += fmt::format(" and {} more", names.size() - most);
  return list;
}

}  // namespace photile::scene

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
    const double fraction = group.power > 0 ? scene.lights[i].power / group.power
                                            : 1.0 / static_cast<double>(group.lights.size());
    group.color += glm::vec3(fraction * glm::dvec3(scene.lights[i].color));
    result.fraction.push_back(fraction);
  }
  return result;
}

}  // namespace photile
