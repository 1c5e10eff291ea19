#include "command/scene_options.hpp"

#include <CLI/CLI.hpp>

namespace photile::app {

void add_scene_options(CLI::App& command, SceneLoadOptions& options, const std::string& group) {
  command
      .add_option("--scene", options.scene,
                  "scene of a glTF file, name or index; default: the file's own, else the first")
      ->type_name("NAME|INDEX")
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
}

}  // namespace photile::app
