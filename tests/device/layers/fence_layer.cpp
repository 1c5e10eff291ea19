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
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "layer.hpp"

namespace {

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

void replace_entries(cl_icd_dispatch& entries) { entries.clCreateBuffer = create_buffer; }
