// Launches of kernels: the kernels of one program, a launch, and launches that end soon.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "device/context.hpp"
#include "photile/statistics.hpp"

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
  /// check their index. With `local_size` 0 the device chooses, and PoCL compiles for each size
  /// that it chooses. Nothing is enqueued for global_size 0. Errors: DeviceError, also where an
  /// argument was not set.
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

// Launches that end soon: a display's watchdog stops kernels that run for seconds, and a user who
// cancels waits for the one that runs.

/// Items of the next launch, from what the last one took: as many as take a tenth of a second, at
/// most four times as many as the last, for the first launches of a kernel are slow.
inline std::uint32_t next_launch(std::uint32_t last, double seconds) {
  constexpr double requested_seconds = 0.1, most_growth = 4;
  constexpr double least = 1024, most = 1u << 30;
  const double growth =
      seconds > 0 ? std::min(requested_seconds / seconds, most_growth) : most_growth;
  return static_cast<std::uint32_t>(std::clamp(last * growth, least, most));
}

/// Cuts the items of a kernel into launches by their measured time. On CPUs, which have no watchdog
/// and whose runtimes share time with others, one launch does all.
class LaunchPace {
 public:
  explicit LaunchPace(Context& context)
      : context_(context), cuts_(context.info().type != DeviceType::cpu) {}

  /// Calls launch(first, count) for [0, total), part by part; parts are multiples of `unit`, except
  /// the last.
  template <class Launch>
  void run(std::uint32_t total, std::uint32_t unit, Launch launch) {
    if (!cuts_) {
      launch(0u, total);
      return;
    }
    for (std::uint32_t first = 0; first < total;) {
      const std::uint32_t part = (items_ + unit - 1) / unit * unit;
      const std::uint32_t count = std::min(part, total - first);
      const Stopwatch stopwatch;
      launch(first, count);
      context_.finish();
      if (count == part)
        items_ = next_launch(part, stopwatch.seconds());  // short remainders tell little
      first += count;
    }
  }

 private:
  Context& context_;
  bool cuts_;
  std::uint32_t items_ = 1u << 14;
};

/// A kernel file and the definitions that it is built with, on one context.
class KernelSet {
 public:
  KernelSet(Context& context, std::string file, Defines defines)
      : context_(&context), file_(std::move(file)), defines_(std::move(defines)) {}

  Context& context() const { return *context_; }
  /// The kernel of a name: see Context::kernel.
  Kernel kernel(const std::string& name) const { return context_->kernel(file_, name, defines_); }
  /// A launch of a kernel of the set.
  Launch launch(const std::string& name) const { return {*context_, kernel(name)}; }

 private:
  Context* context_;
  std::string file_;
  Defines defines_;
};

}  // namespace photile::device
