// Lets Oclgrind 21.10 check for uninitialised values.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_oclgrind_layer.so OCLGRIND_UNINITIALIZED=1
//
// Three faults of its shadow memory make it crash or report what is initialised:
// - It takes each element that clEnqueueFillBuffer sets for a buffer of its own. It follows a write
//   of a whole buffer well, so that fills become writes here.
// - A new buffer at a released one's address keeps the shadow of the old, whose size may be
//   another. So no buffer is released.
// - What a buffer of the host's memory holds (CL_MEM_USE_HOST_PTR) counts as uninitialised. Kernels
//   only read such buffers, so that copies do.
#include <cstring>
#include <vector>

#include "layer.hpp"

namespace {

CL_API_ENTRY cl_int CL_API_CALL fill(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                     size_t pattern_bytes, size_t offset, size_t bytes,
                                     cl_uint wait_count, const cl_event* wait_list,
                                     cl_event* event) {
  std::vector<unsigned char> values(bytes);
  for (size_t i = 0; i < bytes; i += pattern_bytes) {
    std::memcpy(values.data() + i, pattern, pattern_bytes);
  }
  return next->clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, bytes, values.data(),
                                    wait_count, wait_list, event);
}

CL_API_ENTRY cl_mem CL_API_CALL create(cl_context context, cl_mem_flags flags, size_t bytes,
                                       void* host, cl_int* status) {
  if ((flags & CL_MEM_USE_HOST_PTR) != 0) {
    flags = (flags & ~cl_mem_flags{CL_MEM_USE_HOST_PTR}) | CL_MEM_COPY_HOST_PTR;
  }
  return next->clCreateBuffer(context, flags, bytes, host, status);
}

CL_API_ENTRY cl_int CL_API_CALL keep(cl_mem) { return CL_SUCCESS; }

}  // namespace

void replace_entries(cl_icd_dispatch& entries) {
  entries.clCreateBuffer = create;
  entries.clEnqueueFillBuffer = fill;
  entries.clReleaseMemObject = keep;
}
