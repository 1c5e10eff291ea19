// An electric fence around device buffers, for runtimes on the CPU.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_fence_layer.so photile render ...
//
// Every buffer ends at a page that cannot be touched, so that a kernel which reads or writes beyond
// the end dies by SIGSEGV at once; without the layer such a kernel succeeds. Every byte of a new
// buffer is 0xFF, so that what no kernel wrote reads back as NaN or -1. A correct program gives the
// same bits with and without the layer.
//
// The start of a buffer is aligned to the largest power of two, at most 4096, that divides its
// size: a buffer of n elements is aligned as one element is.
//
// PHOTILE_FENCE=guard is for every device, GPUs among them, whose kernels do not touch the host's
// memory: bytes of 0xFF lie before and behind each buffer, and where one is released and they have
// changed, the process says so and aborts. What a kernel reads there is NaN or -1.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <vector>

#include "layer.hpp"

namespace {

bool guards() {
  const char* const fence = std::getenv("PHOTILE_FENCE");
  return fence != nullptr && std::strcmp(fence, "guard") == 0;
}

// A multiple of every alignment that a device asks of a sub-buffer.
constexpr std::size_t guard_bytes = 4096;
constexpr unsigned char guard_byte = 0xFF;

/// The buffer in which a guarded one lies.
struct Whole {
  cl_mem memory;
  cl_context context;
  std::size_t bytes;
};

std::mutex mutex;
std::map<cl_mem, Whole> whole_of;               // of each guarded buffer
std::map<cl_context, cl_command_queue> queues;  // the program's: what it enqueued comes before

CL_API_ENTRY cl_command_queue CL_API_CALL create_queue(cl_context context, cl_device_id device,
                                                       cl_command_queue_properties properties,
                                                       cl_int* status) {
  const cl_command_queue queue = next->clCreateCommandQueue(context, device, properties, status);
  const std::lock_guard lock(mutex);
  queues[context] = queue;
  return queue;
}

cl_mem create_guarded(cl_context context, cl_mem_flags flags, size_t size, void* host,
                      cl_int* status) {
  std::vector<unsigned char> content(size + 2 * guard_bytes, guard_byte);
  if (host != nullptr) std::memcpy(content.data() + guard_bytes, host, size);
  constexpr cl_mem_flags access = CL_MEM_READ_WRITE | CL_MEM_READ_ONLY | CL_MEM_WRITE_ONLY;
  const cl_mem whole = next->clCreateBuffer(context, (flags & access) | CL_MEM_COPY_HOST_PTR,
                                            content.size(), content.data(), status);
  if (whole == nullptr) return nullptr;
  const cl_buffer_region inside{guard_bytes, size};
  const cl_mem buffer =
      next->clCreateSubBuffer(whole, flags & access, CL_BUFFER_CREATE_TYPE_REGION, &inside, status);
  if (buffer == nullptr) {
    next->clReleaseMemObject(whole);
    return nullptr;
  }
  const std::lock_guard lock(mutex);
  whole_of[buffer] = {whole, context, content.size()};
  return buffer;
}

void check_guard(const Whole& whole, std::size_t offset, const char* where) {
  std::vector<unsigned char> read(guard_bytes);
  if (next->clEnqueueReadBuffer(queues.at(whole.context), whole.memory, CL_TRUE, offset,
                                guard_bytes, read.data(), 0, nullptr, nullptr) != CL_SUCCESS) {
    std::fprintf(stderr, "fence: a guard cannot be read\n");
    std::abort();
  }
  const auto changed = [](unsigned char byte) { return byte != guard_byte; };
  if (std::any_of(read.begin(), read.end(), changed)) {
    std::fprintf(stderr, "fence: a kernel wrote %s a buffer of %zu bytes\n", where,
                 whole.bytes - 2 * guard_bytes);
    std::abort();
  }
}

CL_API_ENTRY cl_int CL_API_CALL release_buffer(cl_mem buffer) {
  std::unique_lock lock(mutex);
  const auto found = whole_of.find(buffer);
  cl_uint references = 0;
  next->clGetMemObjectInfo(buffer, CL_MEM_REFERENCE_COUNT, sizeof references, &references, nullptr);
  if (found == whole_of.end() || references > 1) return next->clReleaseMemObject(buffer);
  const Whole whole = found->second;
  check_guard(whole, 0, "before");
  check_guard(whole, whole.bytes - guard_bytes, "behind");
  whole_of.erase(found);
  lock.unlock();
  const cl_int status = next->clReleaseMemObject(buffer);
  next->clReleaseMemObject(whole.memory);
  return status;
}

struct Mapping {
  void* begin;
  std::size_t bytes;
};

void CL_CALLBACK unmap(cl_mem, void* data) {
  const auto* const mapping = static_cast<Mapping*>(data);
  ::munmap(mapping->begin, mapping->bytes);
  delete mapping;
}

CL_API_ENTRY cl_mem CL_API_CALL create_buffer(cl_context context, cl_mem_flags flags, size_t size,
                                              void* host, cl_int* status) {
  // What the program only reads in its own memory is copied; what it writes there must stay there.
  const bool shared = (flags & CL_MEM_USE_HOST_PTR) != 0;
  if (size == 0 || (shared && !(flags & CL_MEM_READ_ONLY))) {
    return next->clCreateBuffer(context, flags, size, host, status);
  }
  if (guards()) return create_guarded(context, flags, size, host, status);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t pages = (size + page - 1) / page * page;
  void* const memory = ::mmap(nullptr, pages + page, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) {
    if (status != nullptr) *status = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return nullptr;
  }
  char* const fence = static_cast<char*>(memory) + pages;
  ::mprotect(fence, page, PROT_NONE);
  char* const begin = fence - size;
  std::memset(begin, 0xFF, size);
  if (shared || (flags & CL_MEM_COPY_HOST_PTR)) std::memcpy(begin, host, size);
  flags &= ~static_cast<cl_mem_flags>(CL_MEM_COPY_HOST_PTR | CL_MEM_ALLOC_HOST_PTR);
  const cl_mem buffer =
      next->clCreateBuffer(context, flags | CL_MEM_USE_HOST_PTR, size, begin, status);
  auto* const mapping = new Mapping{memory, pages + page};
  if (buffer == nullptr) {
    unmap(nullptr, mapping);
  } else if (next->clSetMemObjectDestructorCallback(buffer, unmap, mapping) != CL_SUCCESS) {
    std::abort();
  }
  return buffer;
}

}  // namespace

void replace_entries(cl_icd_dispatch& entries) {
  entries.clCreateBuffer = create_buffer;
  if (!guards()) return;
  entries.clCreateCommandQueue = create_queue;
  entries.clReleaseMemObject = release_buffer;
}
