// Fills buffers by writing to them from the host.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_fill_by_write_layer.so
//
// Oclgrind 21.10's check for uninitialised values takes each element that clEnqueueFillBuffer sets
// for a buffer of its own: it then reports what was filled, and crashes. It follows a write of a
// whole buffer well.
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

}  // namespace

void replace_entries(cl_icd_dispatch& entries) { entries.clEnqueueFillBuffer = fill; }
