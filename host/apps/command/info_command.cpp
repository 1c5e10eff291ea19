#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "command/command_line.hpp"
#include "command/scene_options.hpp"
#include "command/scene_report.hpp"
#include "command/setting_options.hpp"
#include "photile/light_mix.hpp"
#include "photile/scene.hpp"

namespace photile::app {
namespace {

struct InfoOptions {
  std::string scene;
  SceneLoadOptions load;
  bool json = false;
};

void print_text(const Scene& scene, const LightMix& mix) {
  for (const auto& line : scene_summary(scene, mix)) std::cout << line << '\n';
  for (const auto& line : material_summary(scene)) std::cout << line << '\n';
  for (const Camera& camera : scene.cameras) {
    const glm::dvec3 position = in_world(scene, camera).position;
    std::cout << fmt::format("camera: {}: at ({:.4g}, {:.4g}, {:.4g}), {:.4g} degrees high\n",
                             camera.name, position.x, position.y, position.z,
                             glm::degrees(camera.vertical_field_of_view));
  }
  for (const auto& line : info_warnings(scene)) std::cout << "warning: " << line << '\n';
}

void run_info(const InfoOptions& options) {
  Scene scene = load_scene(options.scene, options.load);
  if (scene.lights.empty()) {
    scene.report.warnings.push_back(
        "no lights: to render or measure, place lamps by --luminaires, or give --sky");
  }
  const LightMix mix = LightMix::of(scene, options.load.lumen_per_watt);
  if (options.json) {
    // Names come from files: bytes that are no UTF-8 are replaced, not fatal.
    std::cout
        << scene_json(scene, mix).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
        << '\n';
  } else {
    print_text(scene, mix);
  }
}

}  // namespace

void add_info_command(CLI::App& photile) {
  auto options = std::make_shared<InfoOptions>();
  options->load.may_be_dark = true;
  CLI::App* command = photile.add_subcommand("info", "Say what a scene file holds");
  command->add_option("SCENE", options->scene, "scene file: .obj, .gltf or .glb")
      ->required()
      ->type_name("");
  command->add_flag("--json", options->json, "print JSON");
  add_set_option(*command, {scene_settings(options->load)});
  add_scene_options(*command, options->load, "Scene");
  add_light_options(*command, options->load, "Lights");
  command->callback([options] { run_info(*options); });
}

}  // namespace photile::app
