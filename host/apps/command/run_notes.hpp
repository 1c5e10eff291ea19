// What a command that renders or measures tells before it starts.
#pragma once

#include <vector>

#include "command/render_options.hpp"
#include "photile/device.hpp"
#include "photile/light_mix.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"

namespace photile::app {

/// A line for the device.
void tell_device(const DeviceInfo& device, Progress& progress);

/// What the scene holds, and the first of its warnings.
void tell_scene(const Scene& scene, const LightMix& mix, Progress& progress);

/// Opens the devices that photon maps need, and tells them; none for paths. Errors: those of
/// open_devices.
std::vector<Device> devices_for(const RenderOptions& options, Progress& progress);

}  // namespace photile::app
