#include "command/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "command/number_format.hpp"
#include "command/scene_report.hpp"

namespace photile::app {
namespace {

constexpr std::size_t shown_warnings = 20;  // a broken file may have thousands

}  // namespace

void tell_device(const DeviceInfo& device, Progress& progress) {
  progress.note(fmt::format("device: {} {} ({}, {}), {} compute units, {}", device.id, device.name,
                            device.platform, device.driver_version, device.compute_units,
                            format_bytes(device.global_memory_bytes)));
}

void tell_scene(const Scene& scene, const LightMix& mix, Progress& progress) {
  for (const auto& line : scene_summary(scene, mix)) progress.note(line);
  const auto warnings = scene_warnings(scene);
  for (std::size_t i = 0; i < std::min(warnings.size(), shown_warnings); ++i) {
    progress.note("warning: " + warnings[i]);
  }
  if (warnings.size() > shown_warnings) {
    progress.note(
        fmt::format("warning: {} more; photile info shows all", warnings.size() - shown_warnings));
  }
}

std::vector<Device> devices_for(const RenderOptions& options, Progress& progress) {
  if (options.integrator == Integrator::path) return {};
  std::vector<Device> devices = open_devices(options.device);
  for (const Device& device : devices) tell_device(device.info(), progress);
  return devices;
}

}  // namespace photile::app
