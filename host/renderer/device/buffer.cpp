// Buffers: allocation, transfers, fills.
#include <fmt/format.h>
#include <sys/mman.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "common/process_limits.hpp"
#include "device/context_impl.hpp"

namespace photile::device {
namespace {

cl_mem memory_of(const RawBuffer& buffer) { return static_cast<cl_mem>(buffer.handle()); }

void check_range(const RawBuffer& buffer, std::size_t bytes, std::size_t offset, const char* verb) {
  if (offset > buffer.bytes() || bytes > buffer.bytes() - offset) {
    throw DeviceError(fmt::format("{} of {} bytes at byte {} of a buffer of {} bytes", verb, bytes,
                                  offset, buffer.bytes()),
                      CL_INVALID_VALUE);
  }
}

/// Counts the bytes of a buffer. Returns what counts them off, and releases its memory or keeps it.
std::function<void(void*)> counted(std::size_t bytes, const std::shared_ptr<BufferMemory>& memory,
                                   bool is_kept) {
  memory->live += bytes;
  memory->peak = std::max(memory->peak, memory->live.load());
  return [=](void* released) {
    BufferMemory::Piece piece{MemoryHandle(static_cast<cl_mem>(released)), bytes};
    memory->live -= bytes;
    if (is_kept) memory->keep(std::move(piece));
  };
}

/// Released memory that is kept, at most: a batch of hits and its estimates.
constexpr std::uint64_t most_kept_bytes = std::uint64_t{512} << 20;

constexpr std::size_t huge_page = std::size_t{2} << 20;
constexpr std::size_t least_bytes = 4 * huge_page;

/// Asks the operating system to back a new buffer of a CPU device with large pages: a query reads
/// short ranges all over a map, and with pages of 4 KiB waits for the translation of their
/// addresses. For large buffers; the system may ignore it. Call it before the buffer is first
/// written.
void prefer_huge_pages(cl_command_queue queue, cl_mem memory, std::size_t bytes) {
  if (bytes < least_bytes) return;
  // On a CPU a mapped buffer is the buffer itself; where it is a copy, the advice is merely
  // useless.
  void* const mapped = clEnqueueMapBuffer(queue, memory, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0,
                                          bytes, 0, nullptr, nullptr, nullptr);
  if (mapped == nullptr) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(mapped);
  const std::uintptr_t first = (begin + huge_page - 1) / huge_page * huge_page;
  const std::uintptr_t last = (begin + bytes) / huge_page * huge_page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  clEnqueueUnmapMemObject(queue, memory, mapped, 0, nullptr, nullptr);
}

/// PoCL ends the process when it gets no addresses for a command, or for a buffer that it allocates
/// when it is first used.
constexpr std::uint64_t addresses_for_commands = std::uint64_t{64} << 20;

/// Whether the addresses of the process, of which the host takes more and more, suffice for a
/// buffer of a CPU.
bool has_addresses(const DeviceInfo& info, std::uint64_t bytes) {
  if (info.type != DeviceType::cpu) return true;
  const std::uint64_t left = address_bytes_left();
  return left > addresses_for_commands && bytes <= left - addresses_for_commands;
}

/// Where addresses are bounded, a buffer has its own at once.
cl_mem_flags flags_of_buffers() {
  const bool bounded = address_bytes_left() != std::numeric_limits<std::uint64_t>::max();
  return CL_MEM_READ_WRITE | (bounded ? CL_MEM_ALLOC_HOST_PTR : 0);
}

/// A runtime fills a buffer from one core, and the system clears its memory on the way.
constexpr std::size_t least_bytes_for_all_cores = std::size_t{1} << 20;

/// A block of elements to fill this many bytes with, one block after the other.
std::vector<unsigned char> repeated(const void* element, std::size_t element_bytes,
                                    std::size_t bytes) {
  constexpr std::size_t block_bytes = std::size_t{1} << 18;
  const auto* const first = static_cast<const unsigned char*>(element);
  const std::size_t elements = std::max<std::size_t>(1, block_bytes / element_bytes);
  std::vector<unsigned char> block;
  for (std::size_t i = 0; i < elements && block.size() < bytes; ++i) {
    block.insert(block.end(), first, first + element_bytes);
  }
  return block;
}

}  // namespace

BufferMemory::Piece BufferMemory::take_kept(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  auto best = kept_.end();
  for (auto piece = kept_.begin(); piece != kept_.end(); ++piece) {
    const bool serves = piece->bytes >= bytes && piece->bytes / 2 <= bytes;
    if (serves && (best == kept_.end() || piece->bytes <= best->bytes)) best = piece;
  }
  if (best == kept_.end()) return {};
  Piece taken = std::move(*best);
  kept_.erase(best);
  kept_bytes_ -= taken.bytes;
  return taken;
}

void BufferMemory::keep(Piece piece) {
  const std::lock_guard lock(mutex_);
  kept_bytes_ += piece.bytes;
  kept_.push_back(std::move(piece));
  while (kept_bytes_ > most_kept_bytes) {
    kept_bytes_ -= kept_.front().bytes;
    kept_.erase(kept_.begin());
  }
}

void BufferMemory::release_kept() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
  kept_bytes_ = 0;
}

RawBuffer Context::allocate_elements(std::size_t count, std::size_t element_bytes,
                                     std::string_view what, MemoryPages pages) {
  // OpenCL has no empty buffers; 16 bytes hold an element of any basic type.
  constexpr std::size_t smallest = 16;
  const auto asked = [&] {
    return fmt::format("allocating {} ({} x {} bytes)", what, count, element_bytes);
  };
  const auto& info = impl_->info;
  if (count > std::numeric_limits<std::size_t>::max() / element_bytes ||
      count * element_bytes > info.max_allocation_bytes) {  // no retry makes it fit
    impl_->check(CL_INVALID_BUFFER_SIZE, "clCreateBuffer", asked());
  }
  const std::size_t bytes = count * element_bytes;
  const bool is_large = pages == MemoryPages::large;
  if (auto kept = is_large ? BufferMemory::Piece{} : impl_->memory->take_kept(bytes); kept.memory) {
    return RawBuffer({kept.memory.detach(), counted(kept.bytes, impl_->memory, true)}, bytes);
  }
  cl_mem memory = nullptr;
  const cl_int status = impl_->persevere([&] {
    // Runtimes that allocate on first use accept more than there is and fail, or are killed, later.
    if (!impl_->has_room(bytes) || !has_addresses(info, bytes)) {
      return CL_MEM_OBJECT_ALLOCATION_FAILURE;
    }
    cl_int created = CL_SUCCESS;
    memory = clCreateBuffer(impl_->context.get(), flags_of_buffers(), std::max(bytes, smallest),
                            nullptr, &created);
    return created;
  });
  if (status != CL_SUCCESS) impl_->check(status, "clCreateBuffer", asked());
  if (is_large && info.type == DeviceType::cpu) {
    prefer_huge_pages(impl_->queue.get(), memory, bytes);
  }
  return RawBuffer({memory, counted(bytes, impl_->memory, !is_large)}, bytes);
}

void Context::write_bytes(const RawBuffer& buffer, const void* data, std::size_t bytes,
                          std::size_t offset) {
  check_range(buffer, bytes, offset, "write");
  if (bytes == 0) return;
  // Blocking, so that the caller's memory may go away.
  cl_event event = nullptr;
  const cl_int status = impl_->persevere([&] {
    return clEnqueueWriteBuffer(impl_->queue.get(), memory_of(buffer), CL_TRUE, offset, bytes, data,
                                0, nullptr, impl_->profile ? &event : nullptr);
  });
  impl_->check(status, "clEnqueueWriteBuffer", fmt::format("{} bytes", bytes));
  if (impl_->profile) impl_->transfers.add("write", EventHandle(event));
}

void Context::read_bytes(const RawBuffer& buffer, void* data, std::size_t bytes,
                         std::size_t offset) {
  check_range(buffer, bytes, offset, "read");
  if (bytes == 0) return;
  void* shared = nullptr;
  clGetMemObjectInfo(memory_of(buffer), CL_MEM_HOST_PTR, sizeof shared, &shared, nullptr);
  if (shared == data) return map_bytes(buffer, CL_MAP_READ, bytes, offset, [](void*) {});
  cl_event event = nullptr;
  const cl_int status = impl_->persevere([&] {
    return clEnqueueReadBuffer(impl_->queue.get(), memory_of(buffer), CL_TRUE, offset, bytes, data,
                               0, nullptr, impl_->profile ? &event : nullptr);
  });
  impl_->check(status, "clEnqueueReadBuffer", fmt::format("{} bytes", bytes));
  if (impl_->profile) impl_->transfers.add("read", EventHandle(event));
}

bool Context::shares_host_memory() const { return impl_->info.type == DeviceType::cpu; }

RawBuffer Context::share_bytes(const void* data, std::size_t bytes, std::string_view what,
                               SharedMemory counts) {
  cl_mem memory = nullptr;
  const cl_int status = impl_->persevere([&] {
    if (counts == SharedMemory::counted && !impl_->has_room(bytes)) {
      return CL_MEM_OBJECT_ALLOCATION_FAILURE;
    }
    cl_int created = CL_SUCCESS;
    // The kernels that get what is const only read: constness comes back in their arguments.
    memory = clCreateBuffer(impl_->context.get(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes,
                            const_cast<void*>(data), &created);
    return created;
  });
  if (status != CL_SUCCESS) {
    impl_->check(status, "clCreateBuffer", fmt::format("sharing {} ({} bytes)", what, bytes));
  }
  // The host's memory is in use until the queue is empty.
  cl_command_queue queue = impl_->queue.get();
  clRetainCommandQueue(queue);
  const auto release = counted(counts == SharedMemory::counted ? bytes : 0, impl_->memory, false);
  return RawBuffer({memory,
                    [=](void* shared) {
                      release(shared);
                      clFinish(queue);
                      clReleaseCommandQueue(queue);
                    }},
                   bytes);
}

void Context::write_by(const RawBuffer& buffer, std::size_t bytes, std::size_t first,
                       const std::function<void(void*)>& set) {
  if (bytes == 0) return;
  if (!shares_host_memory()) {
    const auto values = std::make_unique_for_overwrite<unsigned char[]>(bytes);
    set(values.get());
    return write_bytes(buffer, values.get(), bytes, first);
  }
  map_bytes(buffer, CL_MAP_WRITE_INVALIDATE_REGION, bytes, first, set);
}

void Context::map_bytes(const RawBuffer& buffer, std::uint64_t flags, std::size_t bytes,
                        std::size_t first, const std::function<void(void*)>& use) {
  void* mapped = nullptr;
  const cl_int status = impl_->persevere([&] {
    cl_int done = CL_SUCCESS;
    mapped = clEnqueueMapBuffer(impl_->queue.get(), memory_of(buffer), CL_TRUE, flags, first, bytes,
                                0, nullptr, nullptr, &done);
    return done;
  });
  impl_->check(status, "clEnqueueMapBuffer", fmt::format("{} bytes", bytes));
  use(mapped);
  impl_->check(
      clEnqueueUnmapMemObject(impl_->queue.get(), memory_of(buffer), mapped, 0, nullptr, nullptr),
      "clEnqueueUnmapMemObject", fmt::format("{} bytes", bytes));
}

void Context::fill_bytes(const RawBuffer& buffer, const void* pattern, std::size_t pattern_bytes,
                         std::size_t bytes, std::size_t first) {
  check_range(buffer, bytes, first, "fill");
  if (shares_host_memory() && bytes >= least_bytes_for_all_cores) {
    const std::vector<unsigned char> block = repeated(pattern, pattern_bytes, bytes);
    const std::size_t blocks = (bytes + block.size() - 1) / block.size();
    return write_by(buffer, bytes, first, [&](void* memory) {
      tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t i) {
        const std::size_t offset = i * block.size();
        std::memcpy(static_cast<unsigned char*>(memory) + offset, block.data(),
                    std::min(block.size(), bytes - offset));
      });
    });
  }
  if (std::has_single_bit(pattern_bytes) && pattern_bytes <= 128) {
    const cl_int status = impl_->persevere([&] {
      return clEnqueueFillBuffer(impl_->queue.get(), memory_of(buffer), pattern, pattern_bytes,
                                 first, bytes, 0, nullptr, nullptr);
    });
    impl_->check(status, "clEnqueueFillBuffer", fmt::format("{} bytes", bytes));
    return;
  }
  // OpenCL fills with powers of two only: other elements are written block by block.
  const std::vector<unsigned char> block = repeated(pattern, pattern_bytes, bytes);
  for (std::size_t offset = 0; offset < bytes; offset += block.size()) {
    write_bytes(buffer, block.data(), std::min(block.size(), bytes - offset), first + offset);
  }
}

}  // namespace photile::device
