#include "gltf/light_traits.hpp"

#include <fmt/format.h>

#include <map>
#include <unordered_set>

#include "gltf/document.hpp"
#include "photile/limits.hpp"
#include "scene/light_names.hpp"

namespace photile::gltf {

namespace {

/// The number `key`, or 0 where it is absent; outside [lowest, highest] 0 with a warning.
double number_within(const tinygltf::Value& extras, const char* key, double lowest, double highest,
                     const std::string& name, files::Warnings& warnings) {
  if (!extras.Has(key)) return 0;
  const double value = number_member(extras, key, -1.0);
  if (value >= lowest && value <= highest) return value;
  warnings.add("node", name,
               fmt::format("{} is no number from {} to {}; ignored", key, lowest, highest));
  return 0;
}

}  // namespace

reading::LightTraits light_traits(const tinygltf::Value& extras, const std::string& name,
                                  files::Warnings& warnings) {
  constexpr double least_lumens = 1e-12, most_lumens = 1e18;
  return {string_member(extras, "photile_group"),
          number_within(extras, "photile_lumens", least_lumens, most_lumens, name, warnings),
          number_within(extras, "photile_kelvin", limits::min_color_temperature,
                        limits::max_color_temperature, name, warnings)};
}

namespace {

/// The name, or one with a number after it, that no group has.
std::string unused(const std::string& name, std::unordered_set<std::string>& groups) {
  std::string result = scene::clean_light_name(name, limits::max_light_name_bytes);
  for (int number = 2; !groups.insert(result).second; ++number) {
    const std::string suffix = fmt::format("_{}", number);
    result = scene::clean_light_name(name, limits::max_light_name_bytes - suffix.size()) + suffix;
  }
  return result;
}

}  // namespace

std::string lamp_of(const tinygltf::Node& node, const std::string& extension) {
  const tinygltf::Value* found = find_extension(node.extensions, extension.c_str());
  if (found == nullptr) return "";
  return fmt::format("{} {:g}", extension, number_member(*found, "light", -1.0));
}

void group_instances(std::vector<Light>& lights, std::span<const reading::LightSource> sources) {
  std::unordered_set<std::string> groups;
  std::map<reading::LightSource::LampKey, std::vector<std::size_t>> instances;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].group.empty()) {
      groups.insert(scene::clean_light_name(lights[i].group, limits::max_light_name_bytes));
    } else if (!sources[i].lamp.empty()) {
      instances[sources[i].lamp_key()].push_back(i);
    }
  }
  for (const auto& [lamp, members] : instances) {
    if (members.size() < 2) continue;
    const std::string group = unused(lights[members.front()].name, groups);
    for (const std::size_t i : members) lights[i].group = group;
  }
}

}  // namespace photile::gltf
