#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/processes.hpp"
#include "command/scene_options.hpp"
#include "command/scene_report.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/foreign_text.hpp"
#include "photile/device.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"
#include "render/kernel_preparation.hpp"

namespace photile::app {
namespace {

using nlohmann::json;

struct DevicesOptions {
  std::string selector;
  bool json = false;
  bool compile = false;
  bool test = false;
};

json device_json(const DeviceInfo& device, bool selected) {
  return {{"id", device.id},
          {"name", device.name},
          {"platform", device.platform},
          {"vendor", device.vendor},
          {"type", name_of(device.type)},
          {"version", device.version},
          {"driver_version", device.driver_version},
          {"platform_version", device.platform_version},
          {"compute_units", device.compute_units},
          {"clock_mhz", device.clock_mhz},
          {"extensions", device.extensions},
          {"global_memory_bytes", device.global_memory_bytes},
          {"max_allocation_bytes", device.max_allocation_bytes},
          {"local_memory_bytes", device.local_memory_bytes},
          {"max_work_group_size", device.max_work_group_size},
          {"native_float_width", device.native_float_width},
          {"lanes", device.lanes},
          {"denormals", device.denormals},
          {"exact_division", device.exact_division},
          {"test_result", device.test_result},
          {"selected", selected}};
}

std::string device_line(const DeviceInfo& device, bool selected) {
  return fmt::format("{} {:<5} {:<4} {} ({}), {}, {} compute units, {}, largest buffer {}",
                     selected ? '*' : ' ', device.id, name_of(device.type), device.name,
                     device.platform, device.version, device.compute_units,
                     format_bytes(device.global_memory_bytes),
                     format_bytes(device.max_allocation_bytes));
}

void run_compilation(const DevicesOptions& options) {
  handle_signals();
  TerminalProgress progress(false);
  for (Device& device : open_devices({.selector = options.selector})) {
    compile_usual_kernels(device, progress);
    progress.note(fmt::format("kernels of {}: {} compiled, {} already in the cache",
                              device.info().id, device.programs_built(),
                              device.programs_from_cache()));
  }
}

/// Tests the devices that the selector means, or of all but the simulator. Errors: DeviceError
/// where one does not pass.
void run_tests(const DevicesOptions& options) {
  handle_signals();
  const std::string selector = options.selector.empty() ? "all" : options.selector;
  std::size_t failed = 0;
  for (Device& device : open_devices({.selector = selector})) {
    const Stopwatch stopwatch;
    const std::string problem = test_device_and_remember(device);
    throw_if_stop_requested();
    failed += !problem.empty();
    std::cout << fmt::format("{:<5} {}: {} ({:.1f} s)", device.info().id, device.info().name,
                             problem.empty() ? "passed" : "not passed: " + problem,
                             stopwatch.seconds())
              << std::endl;
  }
  if (failed > 0) {
    throw DeviceError(
        "a device computes wrong results; choose another by --device, or update its driver");
  }
}

void run_devices(const DevicesOptions& options) {
  if (options.test) return run_tests(options);
  if (options.compile) return run_compilation(options);
  // Opening the device asks the very code that `render` asks; without any device it says so.
  std::set<std::string> selected;
  for (const Device& device : open_devices({.selector = options.selector})) {
    const DeviceInfo& info = device.info();
    selected.insert(info.parent.empty() ? info.id : info.parent);
  }
  json list = json::array();
  for (const DeviceInfo& device : list_devices()) {
    const bool is_selected = selected.contains(device.id);
    if (options.json) {
      list.push_back(device_json(device, is_selected));
    } else {
      std::cout << device_line(device, is_selected) << '\n';
    }
  }
  if (options.json) {
    std::cout << json_text(list, 2);
  } else {
    std::cout << "* = used by photile render; choose with --device or PHOTILE_DEVICE\n";
  }
}

}  // namespace

void add_devices_command(CLI::App& photile) {
  auto options = std::make_shared<DevicesOptions>();
  CLI::App* command = photile.add_subcommand("devices", "List the OpenCL devices");
  const OptionGroup group(*command);
  CLI::Option* json = group.flag("--json", options->json, "print JSON");
  group.add("--device", options->selector, "SELECTOR",
            "devices to mark, to test or to compile for, as in photile render");
  group
      .flag("--compile", options->compile,
            "compile the kernels of usual scenes in advance, so that the first picture is as quick "
            "as later ones")
      ->excludes(json);
  group
      .flag("--test", options->test,
            "test what each device computes; a GPU is used by default only if it passes; takes "
            "seconds")
      ->excludes(json);
  command->callback([options] { run_devices(*options); });
}

void add_settings_command(CLI::App& photile) {
  CLI::App* command =
      photile.add_subcommand("settings", "List the settings of --set, with defaults and ranges");
  auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown, "print the tables of docs/reference/settings.md");
  command->callback(
      [markdown] { std::cout << (*markdown ? settings_markdown() : settings_text()); });
}

namespace {

struct InfoOptions {
  std::string scene;
  SceneLoadOptions load;
  bool json = false;
};

void print_text(const Scene& scene, const LightMix& mix, const SceneLoadOptions& load) {
  const auto rooms = room_summary(scene);  // an error comes before all lines
  for (const auto& line : scene_summary(scene, mix)) std::cout << line << '\n';
  for (const auto& line : sky_lines(load)) std::cout << line << '\n';
  for (const auto& line : rooms) std::cout << line << '\n';
  for (const auto& line : mesh_summary(scene)) std::cout << line << '\n';
  for (const auto& line : material_summary(scene)) std::cout << line << '\n';
  for (const Camera& camera : scene.cameras) {
    const glm::dvec3 position = in_world(scene, camera).position;
    std::cout << fmt::format("camera: {}: at ({:.4g}, {:.4g}, {:.4g}), {:.4g} degrees high\n",
                             camera.name, position.x, position.y, position.z,
                             glm::degrees(camera.vertical_field_of_view));
  }
  for (const auto& line : info_warnings(scene, mix)) std::cout << "warning: " << line << '\n';
}

void run_info(const InfoOptions& options) {
  Scene scene = load_scene(options.scene, options.load);
  if (scene.lights.empty()) {
    scene.report.warnings.push_back(
        "no lights: to render or measure, place luminaires by --luminaires, or give --sky");
  }
  const LightMix mix = LightMix::of(scene, options.load.lumen_per_watt);
  if (options.json) {
    std::cout << json_text(scene_json(scene, mix, options.load), 2);
  } else {
    print_text(scene, mix, options.load);
  }
}

}  // namespace

void add_info_command(CLI::App& photile) {
  auto options = std::make_shared<InfoOptions>();
  options->load.may_be_dark = true;
  CLI::App* command = photile.add_subcommand("info", "Print what a scene file holds");
  add_scene_file(*command, options->scene);
  command->add_flag("--json", options->json, "print JSON");
  add_set_option(*command, {scene_settings(options->load)});
  add_scene_options(*command, options->load);
  add_light_options(*command, options->load);
  command->callback([options] { run_info(*options); });
}

}  // namespace photile::app
