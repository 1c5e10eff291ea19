// Makes CPU devices pose as GPUs, so that what GPUs run is run where there is none.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_gpu_layer.so
//   PHOTILE_POSED_LANES=64   work-items that run in step, where this is set
//   PHOTILE_POSED_LOCAL=2048 bytes of local memory that it has
//   PHOTILE_POSED_GROUP=16, PHOTILE_POSED_PRIVATE=20000
//                            of a kernel that estimates or finds neighbours: work-items that run
//                            together, and bytes of private memory that one takes
//
// Only the answers to these questions are changed: what is chosen by them is tested, not speed.
#include <cstdlib>
#include <cstring>

#include "layer.hpp"

namespace {

constexpr cl_device_info warp_size = 0x4003;  // CL_DEVICE_WARP_SIZE_NV

cl_int answer(const void* value, size_t value_bytes, size_t bytes, void* out,
              size_t* bytes_needed) {
  if (bytes_needed != nullptr) *bytes_needed = value_bytes;
  if (out == nullptr) return CL_SUCCESS;
  if (bytes < value_bytes) return CL_INVALID_VALUE;
  std::memcpy(out, value, value_bytes);
  return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL device_info(cl_device_id device, cl_device_info name, size_t bytes,
                                            void* out, size_t* bytes_needed) {
  if (name == CL_DEVICE_TYPE) {
    constexpr cl_device_type gpu = CL_DEVICE_TYPE_GPU;
    return answer(&gpu, sizeof gpu, bytes, out, bytes_needed);
  }
  const char* const local = std::getenv("PHOTILE_POSED_LOCAL");
  if (name == CL_DEVICE_LOCAL_MEM_SIZE && local != nullptr) {
    const cl_ulong value = std::strtoul(local, nullptr, 10);
    return answer(&value, sizeof value, bytes, out, bytes_needed);
  }
  const char* const lanes = std::getenv("PHOTILE_POSED_LANES");
  if (name == warp_size && lanes != nullptr) {
    const auto width = static_cast<cl_uint>(std::strtoul(lanes, nullptr, 10));
    return answer(&width, sizeof width, bytes, out, bytes_needed);
  }
  return next->clGetDeviceInfo(device, name, bytes, out, bytes_needed);
}

CL_API_ENTRY cl_int CL_API_CALL group_info(cl_kernel kernel, cl_device_id device,
                                           cl_kernel_work_group_info name, size_t bytes, void* out,
                                           size_t* bytes_needed) {
  char function[64] = "";
  next->clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof function, function, nullptr);
  const bool queries = std::strstr(function, "_by_selection") != nullptr;
  const char* const variable = name == CL_KERNEL_WORK_GROUP_SIZE    ? "PHOTILE_POSED_GROUP"
                               : name == CL_KERNEL_PRIVATE_MEM_SIZE ? "PHOTILE_POSED_PRIVATE"
                                                                    : nullptr;
  const char* const posed = queries && variable != nullptr ? std::getenv(variable) : nullptr;
  if (posed == nullptr) {
    return next->clGetKernelWorkGroupInfo(kernel, device, name, bytes, out, bytes_needed);
  }
  const cl_ulong value = std::strtoul(posed, nullptr, 10);  // of either's size
  return answer(&value, sizeof value, bytes, out, bytes_needed);
}

}  // namespace

void replace_entries(cl_icd_dispatch& entries) {
  entries.clGetDeviceInfo = device_info;
  entries.clGetKernelWorkGroupInfo = group_info;
}
