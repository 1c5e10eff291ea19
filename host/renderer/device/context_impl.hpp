// The state of a Context.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "device/context.hpp"
#include "device/device_list.hpp"
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

/// Device time per kernel, from profiling events.
class KernelTimes {
 public:
  /// Takes over the event of one launch.
  void add(const std::string& kernel, EventHandle event);
  /// Takes over the event of a launch that took `seconds` from its call to its end: the part of
  /// them in which it did not run is preparation.
  void add_first(const std::string& kernel, EventHandle event, double seconds);
  /// Adds seconds spent until a kernel could run.
  void add_preparation(const std::string& kernel, double seconds);
  /// Waits for the launches so far and sums them, by name of the kernels launched.
  std::vector<KernelTime> total();

 private:
  void collect();

  std::vector<std::pair<std::string, EventHandle>> pending_;
  std::map<std::string, KernelTime> totals_;
};

/// The memory of a context's buffers. Shared with them: a buffer may outlive its context.
///
/// Released memory is kept for later buffers. A batch of hits is like the one before, and new
/// memory, which the operating system must clear first, takes a considerable part of the time of
/// the estimates that are written to it.
class BufferMemory {
 public:
  struct Piece {
    MemoryHandle memory{};
    std::size_t bytes = 0;
  };

  /// A kept piece of at least this many bytes, and less than twice as many; else none.
  Piece take_kept(std::size_t bytes);
  void keep(Piece piece);
  void release_kept();
  /// Bytes of live buffers and of kept memory.
  std::uint64_t bytes() const { return live + kept_bytes_; }

  std::atomic<std::uint64_t> live{0};  ///< bytes in live buffers
  std::uint64_t peak = 0;              ///< the most of these

 private:
  std::mutex mutex_;
  std::vector<Piece> kept_;  ///< the one released last at the end
  std::atomic<std::uint64_t> kept_bytes_{0};
};

struct Context::Impl {
  Impl(ListedDevice listed, const DeviceOptions& options);

  /// Throws DeviceError unless `status` is CL_SUCCESS; `what` names the request. Where memory
  /// ran out it is a DeviceMemoryError, and the message adds the limits and a remedy.
  void check(cl_int status, std::string_view call, const std::string& what) const;

  /// The status of `call()`, which has no effect where it runs out of memory. Then it is called
  /// again: once the queue is empty, since runtimes keep released buffers while kernels use them,
  /// without what is kept for later buffers, and after each reclaimer that has released something.
  template <class Call>
  cl_int persevere(const Call& call) {
    cl_int status = call();
    if (!is_out_of_memory(status)) return status;
    clFinish(queue.get());  // if it fails, so does the call
    do {
      memory->release_kept();
      status = call();
    } while (is_out_of_memory(status) && reclaim());
    return status;
  }

  /// Whether a reclaimer has released memory.
  bool reclaim();

  /// Whether this many more bytes are within the limit on memory.
  bool has_room(std::uint64_t bytes) const {
    return bytes <= memory_limit - std::min(memory_limit, memory->bytes());
  }

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
  std::shared_ptr<BufferMemory> memory = std::make_shared<BufferMemory>();
  std::shared_ptr<std::vector<Reclaimer*>> reclaimers =
      std::make_shared<std::vector<Reclaimer*>>();  ///< the one to be asked first is last
  bool reclaiming = false;  ///< calls by a reclaimer itself must not reclaim again
  bool profile = false;
  KernelTimes times;
  KernelTimes transfers;  ///< between host and device, both ways
};

}  // namespace photile::device
