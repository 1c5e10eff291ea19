// Launches every kernel in work-groups of another size.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_work_group_layer.so
//   PHOTILE_WORK_GROUP_SIZE=7   work-items of a group; larger than the kernel can take = its
//   largest
//
// Kernels loop over their items by the global size, so that no result may depend on the size of the
// groups. The number of work-items is rounded down to whole groups, at least one: buffers that hold
// something per work-item stay large enough.
#include <algorithm>
#include <cstdlib>

#include "layer.hpp"

namespace {

size_t requested_size() {
  const char* const value = std::getenv("PHOTILE_WORK_GROUP_SIZE");
  return value == nullptr ? 0 : std::strtoul(value, nullptr, 10);
}

size_t largest_size(cl_command_queue queue, cl_kernel kernel) {
  cl_device_id device = nullptr;
  size_t largest = 1;
  next->clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device, &device, nullptr);
  next->clGetKernelWorkGroupInfo(kernel, device, CL_KERNEL_WORK_GROUP_SIZE, sizeof largest,
                                 &largest, nullptr);
  return largest;
}

CL_API_ENTRY cl_int CL_API_CALL enqueue(cl_command_queue queue, cl_kernel kernel,
                                        cl_uint dimensions, const size_t* offset,
                                        const size_t* global, const size_t* local,
                                        cl_uint wait_count, const cl_event* wait_list,
                                        cl_event* event) {
  static const size_t requested = requested_size();
  if (requested == 0 || dimensions != 1) {
    return next->clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local,
                                        wait_count, wait_list, event);
  }
  const size_t group = std::min({requested, largest_size(queue, kernel), *global});
  const size_t items = *global / group * group;
  return next->clEnqueueNDRangeKernel(queue, kernel, 1, offset, &items, &group, wait_count,
                                      wait_list, event);
}

}  // namespace

void replace_entries(cl_icd_dispatch& entries) { entries.clEnqueueNDRangeKernel = enqueue; }
