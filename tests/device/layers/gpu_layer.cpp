// Makes CPU devices pose as GPUs, so that what GPUs run is run where there is none.
//
//   OPENCL_LAYERS=<build>/tests/device/layers/libphotile_gpu_layer.so
//   PHOTILE_POSED_LANES=64   work-items that run in step, where this is set
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
  const char* const lanes = std::getenv("PHOTILE_POSED_LANES");
  if (name == warp_size && lanes != nullptr) {
    const auto width = static_cast<cl_uint>(std::strtoul(lanes, nullptr, 10));
    return answer(&width, sizeof width, bytes, out, bytes_needed);
  }
  return next->clGetDeviceInfo(device, name, bytes, out, bytes_needed);
}

}  // namespace

void replace_entries(cl_icd_dispatch& entries) { entries.clGetDeviceInfo = device_info; }
