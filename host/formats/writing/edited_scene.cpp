#include "writing/edited_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "common/files.hpp"
#include "files/scene_files.hpp"
#include "loading/load_scene.hpp"
#include "photile/errors.hpp"
#include "photile/light_layers.hpp"
#include "photile/limits.hpp"
#include "photometry/photometric_file.hpp"
#include "scene/light_names.hpp"

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

/// Each light as the mix sets it.
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
    const double power = in_unit(mixed.power, mixed.unit, scene.unit, mix.lumen_per_watt);
    setting.factor = group.power > 0 ? power / group.power : 0;
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
          fmt::format("{}: {}; set it by --light when the file is loaded", light.name,
                      is_picture ? "its pictures are not rewritten" : "comes from an option"));
    }
  }
  return settings;
}

}  // namespace

void refuse_taken(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return;
  throw OutputError(
      fmt::format("{}: the file exists already; remove it, or choose another name", file.string()));
}

// OBJ: the text of the file with a separate library, in which lamps have other Ke.

namespace {

/// What follows `keyword` on a line; none where the line begins with another word.
std::optional<std::string> statement(std::string_view line, std::string_view keyword) {
  line = trimmed(line);
  if (!line.starts_with(keyword)) return std::nullopt;
  line.remove_prefix(keyword.size());
  if (line.empty() || (line[0] != ' ' && line[0] != '\t')) return std::nullopt;
  return std::string(trimmed(line));
}

std::vector<std::string> lines_of(const std::vector<unsigned char>& bytes) {
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool same(const LightSetting& a, const LightSetting& b) {
  constexpr double rounding = 1e-9;
  return std::abs(a.ratio() - b.ratio()) <= rounding * std::max(a.ratio(), b.ratio()) &&
         a.recolored == b.recolored && glm::distance(a.color, b.color) <= rounding;
}

/// The setting of each material. Lights of one material that are set differently keep theirs.
std::map<std::string, LightSetting> settings_of(std::span<const LightSetting> settings,
                                                std::vector<std::string>& left_out) {
  std::map<std::string, LightSetting> of;
  std::map<std::string, std::string> torn;
  for (const LightSetting& light : settings) {
    const auto [entry, first] = of.emplace(light.material, light);
    if (!first && !same(entry->second, light)) torn[light.material] = light.name;
  }
  for (const auto& [material, name] : torn) {
    left_out.push_back(fmt::format(
        "{} and {} share the material {} but are set differently; give each its own material",
        of.at(material).name, name, material));
    of.erase(material);
  }
  return of;
}

/// One number is grey.
glm::dvec3 rgb_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double number = 0; stream >> number;) numbers.push_back(number);
  if (numbers.empty()) return glm::dvec3(0.0);
  if (numbers.size() < 3) return glm::dvec3(numbers[0]);
  return {numbers[0], numbers[1], numbers[2]};
}

/// The lines of a library, lamps with other Ke.
std::string lit_library(const std::vector<std::string>& lines,
                        const std::map<std::string, LightSetting>& settings) {
  std::string text;
  const LightSetting* setting = nullptr;
  for (const std::string& line : lines) {
    if (const auto name = statement(line, "newmtl")) {
      const auto found = settings.find(*name);
      setting = found == settings.end() ? nullptr : &found->second;
    }
    const auto emission = statement(line, "Ke");
    if (emission && setting && setting->changed()) {
      const glm::dvec3 rgb = setting->emission(rgb_of(*emission));
      text += fmt::format("Ke {} {} {}\n", rgb.r, rgb.g, rgb.b);
    } else {
      text += line + "\n";
    }
  }
  return text;
}

/// Writes `copy` and its library, the name of which is that of the copy.
void write_lit_obj(const std::filesystem::path& scene, const std::filesystem::path& copy,
                   std::span<const LightSetting> settings, std::vector<std::string>& left_out) {
  files::SceneFolder folder(scene, true);
  const std::filesystem::path library = std::filesystem::path(copy).replace_extension(".mtl");
  refuse_taken(library);
  std::vector<std::string> libraries;
  std::string text;
  for (const std::string& line : lines_of(folder.read_scene_file())) {
    const auto name = statement(line, "mtllib");
    if (!name) {
      text += line + "\n";
      continue;
    }
    // In place of the first: one library that holds all.
    if (libraries.empty()) text += fmt::format("mtllib {}\n", library.filename().string());
    libraries.push_back(*name);
  }
  std::vector<std::string> lines;
  for (const std::string& name : libraries) {
    try {
      const auto more = lines_of(folder.read(name));
      lines.insert(lines.end(), more.begin(), more.end());
    } catch (const files::ResourceError&) {
      // A library that is missing is a warning when the scene is loaded.
    }
  }
  write_file(library, lit_library(lines, settings_of(settings, left_out)));
  write_file(copy, text);
}

}  // namespace

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
  if (settings.empty())
    throw OutputError(fmt::format("{}: the scene has no light to set", scene.string()));
  if (settings.front().source.node == none) {
    write_lit_obj(scene, copy.file, settings, copy.left_out);
  } else {
    write_lit_gltf(scene, copy.file, settings, options, copy.left_out);
  }
  return copy;
}

}  // namespace photile::writing
