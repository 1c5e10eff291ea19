// What a Context holds.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "device/context.hpp"
#include "device/device_list.hpp"
#include "device/kernel_times.hpp"
#include "device/opencl.hpp"
#include "device/program_library.hpp"

namespace photile::device {

struct Kernel::Impl {
  KernelHandle kernel;
  std::string name;
  unsigned argument_count = 0;
};

struct Context::Impl {
  Impl(ListedDevice listed, const DeviceOptions& options);

  /// Throws DeviceError unless `status` is CL_SUCCESS; `what` says what was asked for. Where memory
  /// ran out the message adds the device's limits and a remedy.
  void check(cl_int status, std::string_view call, const std::string& what) const;

  DeviceInfo info;
  SubDeviceHandle sub_device;  ///< outlives all that is made on it
  ContextHandle context;
  QueueHandle queue;
  std::unique_ptr<ProgramLibrary> programs;
  std::map<std::tuple<std::string, std::string, std::string>, Kernel>
      kernels;  ///< file, name, defines
  std::shared_ptr<MemoryCounter> memory = std::make_shared<MemoryCounter>();
  bool profile = false;
  KernelTimes times;
};

}  // namespace photile::device
