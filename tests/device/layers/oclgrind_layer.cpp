// Lets Oclgrind 21.10 check for uninitialised values.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_oclgrind_layer.so OCLGRIND_UNINITIALIZED=1
//
// Four faults of its shadow memory make it crash or report what is initialised:
// - It takes what clEnqueueWriteBuffer writes, and each element that clEnqueueFillBuffer sets, for
//   all that the buffer has. So a kernel writes here, whose stores it follows well.
// - It does not see what the host writes into a mapped buffer, which is written again, therefore,
//   when it is unmapped.
// - A new buffer at a released one's address keeps the shadow of the old, whose size may be
//   another. So no buffer is released.
// - What a buffer of the host's memory holds (CL_MEM_USE_HOST_PTR) counts as uninitialised. Kernels
//   only read such buffers, so that copies do.
#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "layer.hpp"

namespace {

/// Copies values to a place of a buffer.
cl_kernel copying(cl_context context) {
  static std::map<cl_context, cl_kernel> kernels;
  cl_kernel& kernel = kernels[context];
  if (kernel != nullptr) return kernel;
  const char* source =
      "kernel void copy(global const uchar* values, global uchar* buffer, ulong first) {"
      "  buffer[first + get_global_id(0)] = values[get_global_id(0)]; }";
  cl_program program = next->clCreateProgramWithSource(context, 1, &source, nullptr, nullptr);
  next->clBuildProgram(program, 0, nullptr, "", nullptr, nullptr);
  return kernel = next->clCreateKernel(program, "copy", nullptr);
}

CL_API_ENTRY cl_int CL_API_CALL write(cl_command_queue queue, cl_mem buffer, cl_bool, size_t offset,
                                      size_t bytes, const void* values, cl_uint count,
                                      const cl_event* list, cl_event* event) {
  cl_context context = nullptr;
  next->clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
  cl_kernel kernel = copying(context);
  cl_mem source = next->clCreateBuffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, bytes,
                                       const_cast<void*>(values), nullptr);
  const cl_ulong first = offset;
  next->clSetKernelArg(kernel, 0, sizeof source, &source);
  next->clSetKernelArg(kernel, 1, sizeof buffer, &buffer);
  next->clSetKernelArg(kernel, 2, sizeof first, &first);
  return next->clEnqueueNDRangeKernel(queue, kernel, 1, nullptr, &bytes, nullptr, count, list,
                                      event);
}

CL_API_ENTRY cl_int CL_API_CALL fill(cl_command_queue queue, cl_mem buffer, const void* pattern,
                                     size_t pattern_bytes, size_t offset, size_t bytes,
                                     cl_uint count, const cl_event* list, cl_event* event) {
  std::vector<unsigned char> values(bytes);
  for (size_t i = 0; i < bytes; i += pattern_bytes) {
    std::memcpy(values.data() + i, pattern, pattern_bytes);
  }
  return write(queue, buffer, CL_TRUE, offset, bytes, values.data(), count, list, event);
}

CL_API_ENTRY cl_mem CL_API_CALL create(cl_context context, cl_mem_flags flags, size_t bytes,
                                       void* host, cl_int* status) {
  if ((flags & CL_MEM_USE_HOST_PTR) != 0) {
    flags = (flags & ~cl_mem_flags{CL_MEM_USE_HOST_PTR}) | CL_MEM_COPY_HOST_PTR;
  }
  return next->clCreateBuffer(context, flags, bytes, host, status);
}

/// Offset and bytes of what is mapped, by what the host was given.
std::map<void*, std::pair<size_t, size_t>> mapped;

CL_API_ENTRY void* CL_API_CALL map(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                   cl_map_flags flags, size_t offset, size_t bytes, cl_uint count,
                                   const cl_event* list, cl_event* event, cl_int* status) {
  void* const given = next->clEnqueueMapBuffer(queue, buffer, blocking, flags, offset, bytes, count,
                                               list, event, status);
  if (flags != CL_MAP_READ) mapped[given] = {offset, bytes};
  return given;
}

CL_API_ENTRY cl_int CL_API_CALL unmap(cl_command_queue queue, cl_mem buffer, void* given,
                                      cl_uint count, const cl_event* list, cl_event* event) {
  const auto written = mapped.extract(given);
  const auto [offset, bytes] = written ? written.mapped() : std::pair<size_t, size_t>();
  const auto* const first = static_cast<const unsigned char*>(given);
  const std::vector<unsigned char> values(first, first + bytes);
  const cl_int done = next->clEnqueueUnmapMemObject(queue, buffer, given, count, list, event);
  if (written) write(queue, buffer, CL_TRUE, offset, bytes, values.data(), 0, nullptr, nullptr);
  return done;
}

CL_API_ENTRY cl_int CL_API_CALL keep(cl_mem) { return CL_SUCCESS; }

}  // namespace

void replace_entries(cl_icd_dispatch& entries) {
  entries.clCreateBuffer = create;
  entries.clEnqueueWriteBuffer = write;
  entries.clEnqueueFillBuffer = fill;
  entries.clEnqueueMapBuffer = map;
  entries.clEnqueueUnmapMemObject = unmap;
  entries.clReleaseMemObject = keep;
}
