#include "command/scene_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "view/moods.hpp"

namespace photile::app {

void add_scene_options(CLI::App& command, SceneLoadOptions& options, const std::string& group) {
  command
      .add_option_function<std::vector<std::string>>(
          "--reflectance",
          [&options](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              options.reflectances.push_back(ReflectanceChange::parse(text));
            }
          },
          "fraction of the light that materials whose names match reflect; their colours are made "
          "brighter or darker; repeatable")
      ->type_name("MATERIAL=SHARE")
      ->allow_extra_args(false)
      ->group(group);
}

namespace {

/// An option that may be repeated; each text is parsed by T::parse.
template <class T>
CLI::Option* add_repeatable(CLI::App& command, const char* name, const char* type,
                            const char* description, std::vector<T>& values) {
  return command
      .add_option_function<std::vector<std::string>>(
          name,
          [&values](const std::vector<std::string>& texts) {
            for (const auto& text : texts) values.push_back(T::parse(text));
          },
          description)
      ->type_name(type)
      ->allow_extra_args(false);
}

}  // namespace

void add_situation_options(CLI::App& command, SkySituation& situation, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--site", [&situation](const std::string& text) { situation.site = Site::parse(text); },
          "degrees north, degrees east, hours before Greenwich; default: that of --weather")
      ->type_name("LAT,LON,TZ")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--time",
          [&situation](const std::string& text) { situation.time = LocalTime::parse(text); },
          "the sun's position by the site's standard time, such as 2026-06-21T14:00; with "
          "--weather "
          "the sky of that hour, too")
      ->type_name("YYYY-MM-DDTHH:MM")
      ->group(group);
  command.add_option("--weather", situation.weather, "EnergyPlus weather file")
      ->type_name("FILE.epw")
      ->group(group);
}

void add_light_options(CLI::App& command, SceneLoadOptions& options, const std::string& group) {
  add_repeatable(command, "--light-group", "GLOB=NAME",
                 "lights whose names match become one layer; repeatable", options.light_groups)
      ->group(group);
  add_repeatable(command, "--ies", "NAME=FILE",
                 "photometric file (.ies, .ldt) of a point or spot light; repeatable",
                 options.profiles)
      ->group(group);
  add_repeatable(command, "--area-light", "NAME=WxH,LUMENS",
                 "a luminous rectangle, in metres, at a node of a glTF file; repeatable",
                 options.panels)
      ->group(group);
  command
      .add_option("--luminaires", options.luminaires,
                  "luminaires to place, by their photometric files, alone or in arrays")
      ->type_name("FILE.json")
      ->group(group);
  command
      .add_option("--environment", options.environment.file,
                  "surroundings: an equirectangular picture of radiance, .hdr or .exr")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--sun", [&options](const std::string& text) { options.sun = Sun::parse(text); },
          "degrees from north (-z) by east (+x), degrees above the horizon, lux facing it, and "
          "degrees of its disc, 0.533 if not given; or its lux alone, with --site and --time")
      ->type_name("AZIMUTH,ELEVATION,LUX[,DIAMETER]|LUX")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--sky", [&options](const std::string& text) { options.sky = Sky::parse(text); },
          "uniform, overcast or clear (with --sun), and its lux on a horizontal surface; perez: "
          "W/m2 "
          "facing the sun and on a horizontal surface; patches: 145, 577 or 2305 lights, for "
          "relight --time")
      ->type_name("KIND=LUX|perez=DIRECT,DIFFUSE|patches=N")
      ->group(group);
  add_situation_options(command, options.situation, group);
}

void add_mood_options(CLI::App& command, MoodOptions& options, const std::string& group) {
  command
      .add_option("--mood", options.mood,
                  "lamps as the window kept them under this name; --light changes them further")
      ->type_name("NAME")
      ->group(group);
  add_moods_file_option(command, options.file, group);
}

void add_moods_file_option(CLI::App& command, std::string& file, const std::string& group) {
  command.add_option("--moods", file, "file of moods; default: SCENE's, such as room.moods.json")
      ->type_name("FILE")
      ->group(group);
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
      fmt::format("{}: there is no such file of moods; keep moods in the window, or "
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
