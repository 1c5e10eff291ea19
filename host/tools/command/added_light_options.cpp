#include <CLI/CLI.hpp>
#include <vector>

#include "tools/command/scene_options.hpp"
#include "tools/command/validators.hpp"

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
  add_repeatable(command, "--light-temperature", "NAME=KELVIN",
                 "colour of a light, whose flux stays; repeatable", options.temperatures)
      ->group(group);
  command
      .add_option("--environment", options.environment.file,
                  "surroundings: an equirectangular picture of radiance, .hdr or .exr")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--environment-scale", options.environment.scale,
                  "multiplies the picture, which is in cd/m2, or W/(m2 sr) for OBJ")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--environment-rotation", options.environment.rotation_degrees,
                  "clockwise as seen from above; at 0 the picture's middle lies towards -z")
      ->type_name("DEGREES")
      ->transform(number_between(-360, 360))
      ->capture_default_str()
      ->group(group);
  command
      .add_option_function<std::string>(
          "--sun", [&options](const std::string& text) { options.sun = Sun::parse(text); },
          "degrees from north (-z) by east (+x), degrees above the horizon, lux facing it, and "
          "degrees of its disc, 0.533 if not given")
      ->type_name("AZIMUTH,ELEVATION,LUX[,DIAMETER]")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--sky", [&options](const std::string& text) { options.sky = Sky::parse(text); },
          "uniform, overcast or clear (with --sun), and its lux on a horizontal surface")
      ->type_name("KIND=LUX")
      ->group(group);
}

}  // namespace photile::app
