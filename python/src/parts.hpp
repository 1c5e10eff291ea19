// The parts of the module, each defined in the file of its name.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::python {

void define_devices(pybind11::module_& module);
void define_scenes(pybind11::module_& module);
void define_photons(pybind11::module_& module);
void define_pictures(pybind11::module_& module);
void define_measuring(pybind11::module_& module);

/// Devices stay open while the process lives, with their kernels. One thread works with them at a
/// time.
struct OpenDevices {
  std::vector<Device> devices;
  std::mutex mutex;
};

/// The devices that a selector means, opened when they are first asked for. Errors: DeviceError.
std::shared_ptr<OpenDevices> devices_of(const std::string& selector);

/// A tuple (name, position, forward, up, vertical field of view in radians), in the file's world,
/// as a camera of the scene.
Camera camera_of(const Scene& scene, const pybind11::tuple& parts);

/// Settings by name, from a dictionary of numbers and strings; "quality" is set first. Errors:
/// UsageError that names the setting.
void set_all(RenderParameters& parameters, const pybind11::dict& settings);

}  // namespace photile::python
