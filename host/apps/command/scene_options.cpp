#include "command/scene_options.hpp"

#include <CLI/CLI.hpp>

#include "command/validators.hpp"

namespace photile::app {

void add_scene_options(CLI::App& command, SceneLoadOptions& options, const std::string& group) {
  command
      .add_option("--scene", options.scene,
                  "scene of a glTF file, name or index; default: the file's own, else the first")
      ->type_name("NAME|INDEX")
      ->group(group);
  command
      .add_option(
          "--up", options.up,
          "axis of the file that points up; default: y, and a warning where it seems to be z")
      ->type_name("")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}))
      ->group(group);
  command
      .add_option("--lumen-per-watt,--efficacy", options.lumen_per_watt, "683 or, as Radiance, 179")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--emissive-scale", options.emissive_scale,
                  "multiplies emissive materials; 683 mends files from Blender")
      ->type_name("X")
      ->transform(positive_number())
      ->capture_default_str()
      ->group(group);
  command
      .add_flag("--allow-outside", options.allow_outside,
                "the scene may name files outside its folder")
      ->group(group);
  command
      .add_option_function<std::vector<std::string>>(
          "--reflectance",
          [&options](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              options.reflectances.push_back(ReflectanceChange::parse(text));
            }
          },
          "share of light that materials whose names match reflect; their colours are made "
          "brighter or darker; repeatable")
      ->type_name("MATERIAL=SHARE")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_flag("--lambertian", options.lambertian,
                "no specular lobe on dielectrics, such as the 4% that glTF has by default")
      ->group(group);
}

}  // namespace photile::app
