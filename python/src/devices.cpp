// OpenCL devices, kept open.
#include <pybind11/stl.h>

#include <map>

#include "parts.hpp"
#include "photile/device.hpp"
#include "work.hpp"

namespace py = pybind11;

namespace photile::python {
namespace {

py::list list_of_devices() {
  py::list list;
  std::vector<DeviceInfo> devices;
  {
    const Unlocked unlocked;
    devices = list_devices();
  }
  for (const DeviceInfo& device : devices) {
    py::dict row;
    row["id"] = device.id;
    row["name"] = device.name;
    row["platform"] = device.platform;
    row["type"] = name_of(device.type);
    row["version"] = device.version;
    row["driver_version"] = device.driver_version;
    row["compute_units"] = device.compute_units;
    row["global_memory_bytes"] = device.global_memory_bytes;
    row["max_allocation_bytes"] = device.max_allocation_bytes;
    row["test_result"] = device.test_result;
    list.append(row);
  }
  return list;
}

std::string test_devices(const std::string& selector) {
  const Unlocked unlocked;
  const auto open = devices_of(selector);
  const std::lock_guard lock(open->mutex);
  std::string found;
  for (Device& device : open->devices) {
    const std::string result = test_device(device);
    if (!result.empty()) found += (found.empty() ? "" : "; ") + device.info().id + ": " + result;
  }
  return found;
}

}  // namespace

std::shared_ptr<OpenDevices> devices_of(const std::string& selector) {
  // Never closed: runtimes of OpenCL may be gone when the process ends.
  static auto& open = *new std::map<std::string, std::shared_ptr<OpenDevices>>;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::shared_ptr<OpenDevices>& devices = open[selector];
  if (!devices) {
    auto opened = std::make_shared<OpenDevices>();
    opened->devices = open_devices({.selector = selector});
    devices = std::move(opened);
  }
  return devices;
}

void define_devices(py::module_& module) {
  module.def("devices", &list_of_devices);
  module.def("test_devices", &test_devices);
}

}  // namespace photile::python
