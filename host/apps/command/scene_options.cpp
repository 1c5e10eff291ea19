#include "command/scene_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "command/option_group.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "view/moods.hpp"

namespace photile::app {

void add_scene_file(CLI::App& command, std::string& file) {
  command.add_option("SCENE", file, "scene file: .obj, .gltf or .glb")->required()->type_name("");
}

void add_scene_options(CLI::App& command, SceneLoadOptions& options) {
  OptionGroup(command, "Scene")
      .parse("--reflectance", options.reflectances, "MATERIAL=SHARE",
             "reflectance of materials whose names match; their colours are made brighter or "
             "darker; repeatable");
}

void add_situation_options(const OptionGroup& group, SkySituation& situation) {
  group.parse(
      "--site", situation.site, "LAT,LON,TZ",
      "degrees north, degrees east, time zone in hours ahead of UTC; default: those of --weather");
  group.parse("--time", situation.time, "YYYY-MM-DDTHH:MM",
              "standard time of the site, which gives the position of the sun, such as "
              "2026-06-21T14:00; with --weather the sky of that hour, too");
  group.add("--weather", situation.weather, "FILE.epw", "EnergyPlus weather file");
}

void add_light_options(CLI::App& command, SceneLoadOptions& options) {
  const OptionGroup lights(command, "Lights");
  lights.parse("--light-group", options.light_groups, "GLOB=NAME",
               "lights whose names match become one layer; repeatable");
  lights.parse("--ies", options.profiles, "NAME=FILE",
               "photometric file (.ies, .ldt) of a point or spot light; repeatable");
  lights.parse("--area-light", options.panels, "NAME=WxH,LUMENS",
               "a luminous rectangle, in metres, at a node of a glTF file; repeatable");
  lights.add("--luminaires", options.luminaires, "FILE.json",
             "luminaires to place, alone or in arrays, with their photometric files");
  lights.add("--environment", options.environment.file, "FILE",
             "surroundings: an equirectangular picture of radiance, .hdr or .exr");
  lights.parse(
      "--sun", options.sun, "AZIMUTH,ELEVATION,LUX[,DIAMETER]|LUX",
      "degrees from north (-z) towards east (+x), degrees above the horizon, lux facing the sun, "
      "and degrees across its disc, 0.533 if not given; or its lux alone, with --site and --time");
  lights.parse("--sky", options.sky, "KIND=LUX|perez=DIRECT,DIFFUSE|patches=N",
               "uniform, overcast or clear (with --sun), and its lux on a horizontal surface; "
               "perez: direct W/m2 facing the sun and diffuse W/m2 on a horizontal surface; "
               "patches: 145, 577 or 2305 lights, for relight --time");
  add_situation_options(lights, options.situation);
}

void add_light_change_option(const OptionGroup& group, std::vector<LightChange>& changes) {
  group.parse("--light", changes, "NAME=POWER|xFACTOR|N%|#RRGGBB|KELVINK|off",
              "change all lights whose names match a glob: power in their unit, a factor (x2), per "
              "cent, a colour, a colour temperature or off; repeatable");
}

void add_mood_options(const OptionGroup& group, MoodOptions& options) {
  group.add("--mood", options.mood, "NAME",
            "mood saved on the live page under this name; --light changes it further");
  add_moods_file_option(group, options.file);
}

void add_moods_file_option(const OptionGroup& group, std::string& file) {
  group.add("--moods", file, "FILE", "file of moods; default: SCENE's, such as room.moods.json");
}

std::filesystem::path moods_file(const std::string& given, const std::filesystem::path& scene,
                                 const std::filesystem::path& picture) {
  std::vector<std::filesystem::path> files;
  if (!given.empty()) files.emplace_back(given);
  if (given.empty() && !scene.empty()) files.push_back(view::Moods::file_of(scene));
  if (given.empty() && !picture.empty()) files.push_back(view::Moods::file_of(picture));
  for (const auto& file : files) {
    if (std::filesystem::exists(file)) return file;
  }
  throw UsageError(
      fmt::format("{}: there is no such moods file; save moods on the live page, or "
                  "give --moods FILE",
                  files.front().string()));
}

std::vector<LightChange> changes_of(const MoodOptions& options, const LightMix& mix,
                                    const std::filesystem::path& scene) {
  if (!options.asked()) return {};
  const std::filesystem::path file = moods_file(options.file, scene);
  if (!options.edited) note_input(file);
  const view::Moods moods(file);
  return moods.changes(options.mood, mix);
}

std::filesystem::path moods_of_picture(const std::string& given,
                                       const std::filesystem::path& picture) {
  const PictureHeader header = read_header(picture);
  std::filesystem::path scene;
  if (const auto name = header.attributes.find("photile.scene"); name != header.attributes.end()) {
    scene = picture.parent_path() / std::filesystem::path(name->second).filename();
  }
  return moods_file(given, scene, picture);
}

std::vector<LightChange> mood_of_picture(const MoodOptions& options,
                                         const std::filesystem::path& picture) {
  if (!options.asked()) return {};
  const std::string file = moods_of_picture(options.file, picture).string();
  return changes_of({options.mood, file}, read_light_mix(picture), {});
}

std::vector<LightChange> joined(std::vector<LightChange> mood,
                                const std::vector<LightChange>& lights) {
  mood.insert(mood.end(), lights.begin(), lights.end());
  return mood;
}

}  // namespace photile::app
