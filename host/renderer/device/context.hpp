// The interface to OpenCL for host/renderer/maps and host/renderer/estimate. No OpenCL header is
// included here: handles are opaque, so that host/renderer/device stays the only folder that uses
// OpenCL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "photile/device.hpp"
#include "photile/errors.hpp"

namespace photile::device {

class Context;
struct ListedDevice;  // device_list.hpp

/// Holds buffers whose content can be restored. It is asked to release memory where an allocation
/// or a launch fails for lack of it; the newest reclaimer is asked first. May outlive its context.
class Reclaimer {
 public:
  explicit Reclaimer(Context& context);
  Reclaimer(const Reclaimer&) = delete;
  Reclaimer& operator=(const Reclaimer&) = delete;

  /// Releases some memory. False where nothing is left to release.
  virtual bool reclaim() = 0;

 protected:
  ~Reclaimer();

 private:
  std::shared_ptr<std::vector<Reclaimer*>> all_;  ///< of the context
};

/// A device buffer. Move-only; released on destruction.
class RawBuffer {
 public:
  RawBuffer() = default;
  std::size_t bytes() const { return memory_ == nullptr ? 0 : bytes_; }
  void* handle() const { return memory_.get(); }  ///< a cl_mem

 private:
  friend class Context;
  /// With what releases it.
  using Memory = std::unique_ptr<void, std::function<void(void* memory)>>;
  RawBuffer(Memory memory, std::size_t bytes) : memory_(std::move(memory)), bytes_(bytes) {}

  Memory memory_;
  std::size_t bytes_ = 0;
};

/// A device buffer of `size()` elements of T. A buffer of zero elements is a valid kernel argument.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(RawBuffer raw, std::size_t size) : raw_(std::move(raw)), size_(size) {}
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  const RawBuffer& raw() const { return raw_; }

 private:
  RawBuffer raw_;
  std::size_t size_ = 0;
};

/// Whether memory that a device shares with the host counts towards the bound on the device's
/// memory. Data that comes in parts does, so that a bound makes the parts small; data that exists
/// in any case does not.
enum class SharedMemory { uncounted, counted };

/// The kind of memory that a buffer of a CPU device is made of.
enum class MemoryPages {
  ordinary,
  /// Large pages, where the operating system has them: for data that is kept and read in many short
  /// ranges. They are not worthwhile for a buffer that lives for one call, because the system has
  /// to clear them each time.
  large
};

/// A local-memory argument of a kernel.
struct LocalMemory {
  std::size_t bytes;
};

/// Compile-time definitions of a program: "-D NAME=VALUE" each, in order. They are part of the
/// cache key.
class Defines {
 public:
  Defines& set(std::string name, long long value);
  Defines& set(std::string name, double value);  ///< as a float literal that round-trips
  Defines& set(std::string name);                ///< as 1
  std::string options() const;

 private:
  std::vector<std::pair<std::string, std::string>> entries_;
};

/// The resources that a built kernel takes, as its device reports them.
struct KernelResources {
  std::uint64_t private_bytes = 0;  ///< of a work-item, in memory for lack of registers
  std::uint64_t local_bytes = 0;    ///< of a group
  std::size_t largest_group = 0;    ///< work-items of it that the device can run together
};

/// A kernel of a built program. Copyable; arguments are set by each Launch.
class Kernel {
 public:
  Kernel() = default;
  struct Impl;
  explicit Kernel(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  Impl& impl() const { return *impl_; }
  const KernelResources& resources() const;

 private:
  std::shared_ptr<Impl> impl_;
};

/// Total time of one kernel, where DeviceOptions::profile is set.
struct KernelTime {
  std::string kernel;
  std::uint64_t launches = 0;
  double seconds = 0;
  /// The time until it could first run: work that the runtime defers to the first launch. The time
  /// of its program is a ProgramTime.
  double preparation_seconds = 0;
};

/// Time until a program was ready, built or loaded.
struct ProgramTime {
  std::string file;
  double seconds = 0;
};

/// One device's context and in-order queue. Not thread-safe: one thread drives it.
/// Every member throws DeviceError naming the call and the status; DeviceMemoryError where memory
/// ran out even after waiting for the queue and releasing all that the reclaimers can release.
class Context {
 public:
  /// Opens the one device that the selector means.
  explicit Context(const DeviceOptions& options);
  /// Opens each device that the selector means.
  static std::vector<std::unique_ptr<Context>> open_all(const DeviceOptions& options);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const DeviceInfo& info() const;
  /// Bytes that live buffers may take together: the device's memory, or the user's bound.
  std::uint64_t memory_limit() const;
  /// Bytes of the largest buffer that can be allocated when no other is live.
  std::uint64_t largest_buffer() const;

  /// Allocates `size` elements. Errors: DeviceMemoryError that names `what`, the bytes and the
  /// limits when it does not fit.
  template <class T>
  Buffer<T> allocate(std::size_t size, std::string_view what,
                     MemoryPages pages = MemoryPages::ordinary) {
    return Buffer<T>(allocate_elements(size, sizeof(T), what, pages), size);
  }
  /// Allocates and fills from the host.
  template <class T>
  Buffer<T> upload(std::span<const T> values, std::string_view what) {
    auto buffer = allocate<T>(values.size(), what);
    write(buffer, values);
    return buffer;
  }
  /// A buffer that kernels read and that holds `values`, which must not change during its life: the
  /// host's memory itself where the device is the host's processor, else a copy.
  template <class T>
  Buffer<T> share(std::span<const T> values, std::string_view what,
                  SharedMemory counts = SharedMemory::uncounted) {
    if (!shares_host_memory() || values.empty()) return upload(values, what);
    return Buffer<T>(share_bytes(values.data(), values.size_bytes(), what, counts), values.size());
  }
  /// A buffer of zeros, to be read into `values`, which are zeros and must not move during its
  /// life: the host's memory itself where the device is the host's processor, so that nothing is
  /// cleared or copied.
  template <class T>
  Buffer<T> share_output(std::span<T> values, std::string_view what) {
    if (shares_host_memory()) return share<T>(values, what, SharedMemory::counted);
    auto buffer = allocate<T>(values.size(), what);
    fill(buffer, T{});
    return buffer;
  }
  /// Allocates, and lets `set(values)` write all elements, directly into the device's memory where
  /// that is the host's.
  template <class T, class Set>
  Buffer<T> upload_by(std::size_t size, std::string_view what, const Set& set) {
    auto buffer = allocate<T>(size, what);
    write_by(buffer.raw(), buffer.bytes(), 0,
             [&](void* memory) { set(std::span(static_cast<T*>(memory), size)); });
    return buffer;
  }
  template <class T>
  void write(Buffer<T>& buffer, std::span<const T> values, std::size_t first = 0) {
    write_bytes(buffer.raw(), values.data(), values.size_bytes(), first * sizeof(T));
  }
  /// Blocking read of `out.size()` elements from `first` on.
  template <class T>
  void read(const Buffer<T>& buffer, std::span<T> out, std::size_t first = 0) {
    read_bytes(buffer.raw(), out.data(), out.size_bytes(), first * sizeof(T));
  }
  /// The content of a buffer, to be restored later.
  template <class T>
  std::vector<std::byte> save(const Buffer<T>& buffer) {
    std::vector<std::byte> content(buffer.bytes());
    read_bytes(buffer.raw(), content.data(), content.size(), 0);
    return content;
  }
  /// Allocates `buffer` anew, with content that was saved.
  template <class T>
  void restore(Buffer<T>& buffer, std::span<const std::byte> content, std::string_view what,
               MemoryPages pages = MemoryPages::ordinary) {
    buffer = allocate<T>(content.size() / sizeof(T), what, pages);
    write_bytes(buffer.raw(), content.data(), content.size(), 0);
  }
  /// Sets every element.
  template <class T>
  void fill(Buffer<T>& buffer, T value) {
    fill(buffer, value, 0, buffer.size());
  }
  /// Sets elements [first, first + count).
  template <class T>
  void fill(Buffer<T>& buffer, T value, std::size_t first, std::size_t count) {
    if (count == 0) return;
    fill_bytes(buffer.raw(), &value, sizeof(T), count * sizeof(T), first * sizeof(T));
  }

  /// The kernel `name` of the embedded kernel file `file` (path below kernels/, e.g.
  /// "grid/build.cl"), built with `defines`. Programs are built once per (file, defines), from the
  /// cache on disk where it holds them. Errors: KernelBuildError with the log; DeviceError where
  /// the runtime does not report the names of arguments.
  Kernel kernel(const std::string& file, const std::string& name, const Defines& defines);

  /// Waits for everything enqueued.
  void finish();

  double compile_seconds() const;
  std::uint64_t programs_built() const;
  std::uint64_t programs_from_cache() const;
  std::uint64_t allocated_bytes() const;       ///< live buffers
  std::uint64_t peak_allocated_bytes() const;  ///< since construction
  std::vector<KernelTime> kernel_times() const;
  /// Of writes and reads of buffers; 0 unless DeviceOptions::profile is set. Memory that a device
  /// shares with the host is not moved.
  double transfer_seconds() const;
  const std::vector<ProgramTime>& program_times() const;  ///< in the order of their first use

 private:
  friend class Reclaimer;
  friend class Launch;  // launch.hpp
  struct Impl;
  std::unique_ptr<Impl> impl_;

  Context(ListedDevice&& listed, const DeviceOptions& options);

  RawBuffer allocate_elements(std::size_t count, std::size_t element_bytes, std::string_view what,
                              MemoryPages pages);
  void write_bytes(const RawBuffer& buffer, const void* data, std::size_t bytes,
                   std::size_t offset);
  void read_bytes(const RawBuffer& buffer, void* data, std::size_t bytes, std::size_t offset);
  /// Maps these bytes of the buffer and calls use(memory); `flags` are OpenCL's.
  void map_bytes(const RawBuffer& buffer, std::uint64_t flags, std::size_t bytes, std::size_t first,
                 const std::function<void(void*)>& use);
  /// `set(memory)` writes these bytes.
  void write_by(const RawBuffer& buffer, std::size_t bytes, std::size_t first,
                const std::function<void(void*)>& set);
  void fill_bytes(const RawBuffer& buffer, const void* pattern, std::size_t pattern_bytes,
                  std::size_t bytes, std::size_t offset);
  bool shares_host_memory() const;
  RawBuffer share_bytes(const void* data, std::size_t bytes, std::string_view what,
                        SharedMemory counts);
};

}  // namespace photile::device
