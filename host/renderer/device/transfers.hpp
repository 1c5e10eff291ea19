// Transfers beside the kernels: to and from a card's memory on a queue of their own, through pinned
// memory, while kernels run on the other.
#pragma once

#include <array>
#include <cstddef>

#include "device/opencl.hpp"

namespace photile::device {

/// Both directions go through two halves of pinned memory: one is copied by the host while the
/// device copies the other.
class Transfers {
 public:
  /// Errors: DeviceError.
  Transfers(cl_context context, cl_device_id device);
  ~Transfers();
  Transfers(const Transfers&) = delete;
  Transfers& operator=(const Transfers&) = delete;

  // Both return when all is copied, or the status of the first call that failed; they may be called
  // again then.

  /// No kernel that was enqueued before may use `to`.
  cl_int write(cl_mem to, const void* data, std::size_t bytes);
  /// Once `after` has happened.
  cl_int read(cl_event after, cl_mem from, void* data, std::size_t bytes);

 private:
  static constexpr std::size_t half_bytes = std::size_t{4} << 20;

  struct Half {
    unsigned char* memory = nullptr;
    EventHandle copied;  ///< the device's last copy
  };
  static cl_int wait(Half& half);
  /// Keeps the event of a command that `enqueue(events, list, event)` puts into the queue.
  template <class Enqueue>
  cl_int start(Half& half, cl_event after, const Enqueue& enqueue);

  QueueHandle queue_;
  MemoryHandle pinned_;
  void* mapped_ = nullptr;
  std::array<Half, 2> halves_;
};

}  // namespace photile::device
