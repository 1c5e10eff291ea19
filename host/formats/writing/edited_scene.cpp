#include "writing/edited_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "loading/sourced_scene.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "scene/light_names.hpp"
#include "writing/light_setting.hpp"

namespace photile::writing {
namespace {

/// Whether an option of the command line, and not the file, says what the light emits.
bool set_by_option(const Light& light, const SceneLoadOptions& options) {
  return std::any_of(options.profiles.begin(), options.profiles.end(),
                     [&](const LightProfile& profile) { return profile.light == light.name; });
}

bool colored_by_option(const Light& light, const SceneLoadOptions& options) {
  return std::any_of(
      options.temperatures.begin(), options.temperatures.end(),
      [&](const LightTemperature& temperature) { return temperature.light == light.name; });
}

/// The layers that instances of each lamp are in.
std::map<reading::LightSource::LampKey, std::set<std::uint32_t>> layers_of_lamps(
    const loading::SourcedScene& sourced, const LightGroups& groups) {
  std::map<reading::LightSource::LampKey, std::set<std::uint32_t>> layers;
  for (std::size_t i = 0; i < sourced.sources.size(); ++i) {
    layers[sourced.sources[i].lamp_key()].insert(groups.group_of[i]);
  }
  return layers;
}

/// What the mix makes of each light.
std::vector<LightSetting> settings_of(const loading::SourcedScene& sourced,
                                      const SceneLoadOptions& options, const LightMix& mix,
                                      std::vector<std::string>& left_out) {
  const Scene& scene = sourced.scene;
  const LightGroups groups = light_groups_of(scene);
  const auto layers = layers_of_lamps(sourced, groups);
  std::vector<LightSetting> settings;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const LightGroup& group = groups.groups[groups.group_of[i]];
    const MixedLight& mixed = mix.lights.at(groups.group_of[i]);
    LightSetting setting;
    setting.source = sourced.sources[i];
    setting.shared =
        !setting.source.lamp.empty() && layers.at(setting.source.lamp_key()).size() == 1;
    setting.name = light.name;
    setting.old_power = light.power;
    setting.tint = glm::dvec3(mixed.tint);
    // The tint keeps the luminance of the group's colour, not of each member's.
    const glm::dvec3 color = setting.tint * glm::dvec3(light.color);
    const double bright = luminance(color);
    setting.color = bright > 0 ? color / bright : glm::dvec3(1.0);
    setting.factor = group.power > 0 ? mixed.power / group.power : 0;
    setting.power = light.power * setting.factor * bright;
    setting.recolored = mixed.tint != glm::vec3(1.0f) || colored_by_option(light, options);
    if (setting.source.kind == reading::LightSource::Kind::surface) {
      setting.material = scene.materials[setting.source.material].name;
    }
    setting.textured = light.emission_texture != none;
    const bool is_picture = setting.source.kind == reading::LightSource::Kind::picture;
    const bool by_option = setting.source.kind == reading::LightSource::Kind::surroundings ||
                           set_by_option(light, options);
    if (!is_picture && !by_option) {
      settings.push_back(setting);
    } else if (setting.changed()) {
      left_out.push_back(
          fmt::format("{}: {}; set it where the file is loaded", light.name,
                      is_picture ? "its pictures stay as they are" : "comes from an option"));
    }
  }
  return settings;
}

}  // namespace

void refuse_taken(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  throw OutputError(
      fmt::format("{}: is there already; remove it, or take another name", file.string()));
}

EditedScene write_edited_scene(const std::filesystem::path& scene, const SceneLoadOptions& options,
                               const LightMix& mix, const std::string& name) {
  EditedScene copy;
  const std::string clean = scene::clean_light_name(name, limits::max_light_name_bytes);
  copy.file = scene;
  copy.file.replace_filename(
      fmt::format("{}.{}{}", scene.stem().string(), clean, scene.extension().string()));
  refuse_taken(copy.file);
  const std::vector<LightSetting> settings =
      settings_of(loading::load_sourced_scene(scene, options), options, mix, copy.left_out);
  if (settings.empty()) throw OutputError(fmt::format("{}: has no light to set", scene.string()));
  if (settings.front().source.node == none) {
    write_lit_obj(scene, copy.file, settings, copy.left_out);
  } else {
    write_lit_gltf(scene, copy.file, settings, options, copy.left_out);
  }
  return copy;
}

}  // namespace photile::writing
