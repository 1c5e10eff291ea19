#include <CLI/CLI.hpp>
#include <vector>

#include "command/scene_options.hpp"

namespace photile::app {
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
          "the sun's place by the site's standard time, such as 2026-06-21T14:00; with --weather "
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
                  "lamps to place, by their photometric files, alone or in arrays")
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
  command
      .add_option("--portals", options.portals,
                  "windows that photons of suns and skies start through: auto finds them, off, or "
                  "globs of the materials of their panes; repeatable")
      ->type_name("auto|off|GLOB")
      ->allow_extra_args(false)
      ->group(group);
}

}  // namespace photile::app
