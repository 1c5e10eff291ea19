// What a command prints before it starts, and the cost of its run.
#pragma once

#include <string>
#include <vector>

#include "command/render_options.hpp"
#include "command/run_record.hpp"
#include "device/context.hpp"
#include "photile/device.hpp"
#include "photile/layered_picture.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"

namespace photile::app {

/// A line for the device.
void tell_device(const DeviceInfo& device, Progress& progress);

/// The contents of the scene, sky_lines, and the first of its warnings.
///   load   what it was loaded with
void tell_scene(const Scene& scene, const LightMix& mix, const SceneLoadOptions& load,
                Progress& progress);

/// Opens the devices that photon maps need, and prints them; none for paths. Errors: those of
/// open_devices.
std::vector<Device> devices_for(const RenderOptions& options, Progress& progress);

/// The time that loading its libraries took; to be called at the start. Wall clock to a hundredth
/// of a second; processor seconds where the system does not provide it.
TimeTaken time_of_loading();

/// A line per stage: seconds, memory on host and device, figures; then the total.
std::vector<std::string> summary_table(const RunRecord& record);

/// A line per kernel: launches, total and mean time, slowest first.
std::vector<std::string> kernel_table(std::vector<device::KernelTime> times);

}  // namespace photile::app
