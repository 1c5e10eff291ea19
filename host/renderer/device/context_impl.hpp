// The state of a Context.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "device/context.hpp"
#include "device/device_list.hpp"
#include "device/kernel.hpp"
#include "device/opencl.hpp"
#include "device/program_library.hpp"

namespace photile::device {

struct Kernel::Impl {
  KernelHandle kernel;
  std::string name;
  std::vector<std::string> arguments;  ///< names, in the order of the kernel's source
  KernelResources resources;
  std::size_t required_group = 0;  ///< work-items that its source asks for, or 0
  bool launched = false;
};

/// Counts the contexts of this process.
class LiveContext {
 public:
  LiveContext() { ++live(); }
  ~LiveContext() { --live(); }
  LiveContext(const LiveContext&) = delete;
  LiveContext& operator=(const LiveContext&) = delete;
  static int count() { return live(); }

 private:
  static std::atomic<int>& live() {
    static std::atomic<int> count{0};
    return count;
  }
};

struct Context::Impl {
  Impl(ListedDevice listed, const DeviceOptions& options);

  /// Throws DeviceError unless `status` is CL_SUCCESS; `what` says what was asked for. Where memory
  /// ran out it is a DeviceMemoryError, and the message adds the limits and a remedy.
  void check(cl_int status, std::string_view call, const std::string& what) const;

  /// The status of `call()`, which has no effect where it runs out of memory. Then it is called
  /// again: once the queue is empty, since runtimes keep released buffers while kernels use them,
  /// and after each reclaimer that has released something.
  template <class Call>
  cl_int persevere(const Call& call) {
    cl_int status = call();
    if (!is_out_of_memory(status)) return status;
    clFinish(queue.get());  // should it fail, so does the call
    status = call();
    while (is_out_of_memory(status) && reclaim()) status = call();
    return status;
  }

  /// Whether a reclaimer has released memory.
  bool reclaim();

  LiveContext live;
  DeviceInfo info;
  SubDeviceHandle sub_device;  ///< outlives all that is made on it
  cl_device_id device = nullptr;
  bool limited = false;  ///< the user bounds the memory
  std::uint64_t memory_limit = 0;
  ContextHandle context;
  QueueHandle queue;
  std::unique_ptr<ProgramLibrary> programs;
  std::map<std::tuple<std::string, std::string, std::string>, Kernel>
      kernels;  ///< file, name, defines
  std::shared_ptr<MemoryCounter> memory = std::make_shared<MemoryCounter>();
  std::shared_ptr<ReclaimerList> reclaimers = std::make_shared<ReclaimerList>();
  bool reclaiming = false;  ///< what a reclaimer itself calls must not ask for memory again
  bool profile = false;
  KernelTimes times;
  KernelTimes transfers;  ///< between host and device, both ways
};

}  // namespace photile::device
