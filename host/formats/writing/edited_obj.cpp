// OBJ: the text of the file with a library of its own, in which lamps have other Ke.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "common/output_file.hpp"
#include "files/scene_folder.hpp"
#include "files/warnings.hpp"
#include "photometry/photometric_text.hpp"
#include "writing/light_setting.hpp"

namespace photile::writing {
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
    left_out.push_back(
        fmt::format("{} and {}: share the material {} but are set differently; give "
                    "each its own",
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

}  // namespace

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

}  // namespace photile::writing
