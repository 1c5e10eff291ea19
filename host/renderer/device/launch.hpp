// A launch of a kernel.
#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <vector>

#include "device/context.hpp"

namespace photile::device {

/// Gives a kernel its arguments, by the names that its source gives them, and runs it. Buffers must
/// live until it is enqueued. One launch of a kernel at a time: its arguments are kept in it.
/// Errors: DeviceError that names kernel and argument.
class Launch {
 public:
  Launch(Context& context, Kernel kernel);

  template <class T>
  Launch& set(std::string_view name, const Buffer<T>& buffer) {
    void* const memory = buffer.raw().handle();
    return set_bytes(name, &memory, sizeof memory);
  }
  Launch& set(std::string_view name, const LocalMemory& local) {
    return set_bytes(name, nullptr, local.bytes);
  }
  template <class T>
  Launch& set(std::string_view name, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return set_bytes(name, &value, sizeof(T));
  }

  /// Enqueues the kernel over at least `global_size` work-items, in groups of `local_size`: kernels
  /// check their index. `local_size` 0 lets the device choose, and PoCL compile for each size that
  /// it chooses. Nothing is enqueued for global_size 0. Errors: DeviceError, also where an argument
  /// was not set.
  void run(std::size_t global_size, std::size_t local_size);

  /// Runs kernels that have memory for each work-item over `global_size` of them, rounded up to a
  /// multiple of `local_size`.
  void run_no_more(std::size_t global_size, std::size_t local_size);

 private:
  void enqueue(std::size_t global_size, std::size_t local_size);
  Launch& set_bytes(std::string_view name, const void* value, std::size_t bytes);

  Context& context_;
  Kernel kernel_;
  std::vector<bool> is_set_;  ///< per argument
};

}  // namespace photile::device
