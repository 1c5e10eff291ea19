#include "device/opencl.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::device {
namespace {

/// Without CL_, from code 0 downwards, and from -30.
constexpr std::array names_from_0 = {"SUCCESS",
                                     "DEVICE_NOT_FOUND",
                                     "DEVICE_NOT_AVAILABLE",
                                     "COMPILER_NOT_AVAILABLE",
                                     "MEM_OBJECT_ALLOCATION_FAILURE",
                                     "OUT_OF_RESOURCES",
                                     "OUT_OF_HOST_MEMORY",
                                     "PROFILING_INFO_NOT_AVAILABLE",
                                     "MEM_COPY_OVERLAP",
                                     "IMAGE_FORMAT_MISMATCH",
                                     "IMAGE_FORMAT_NOT_SUPPORTED",
                                     "BUILD_PROGRAM_FAILURE",
                                     "MAP_FAILURE",
                                     "MISALIGNED_SUB_BUFFER_OFFSET",
                                     "EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST",
                                     "COMPILE_PROGRAM_FAILURE",
                                     "LINKER_NOT_AVAILABLE",
                                     "LINK_PROGRAM_FAILURE",
                                     "DEVICE_PARTITION_FAILED",
                                     "KERNEL_ARG_INFO_NOT_AVAILABLE"};
constexpr std::array names_from_30 = {"INVALID_VALUE",
                                      "INVALID_DEVICE_TYPE",
                                      "INVALID_PLATFORM",
                                      "INVALID_DEVICE",
                                      "INVALID_CONTEXT",
                                      "INVALID_QUEUE_PROPERTIES",
                                      "INVALID_COMMAND_QUEUE",
                                      "INVALID_HOST_PTR",
                                      "INVALID_MEM_OBJECT",
                                      "INVALID_IMAGE_FORMAT_DESCRIPTOR",
                                      "INVALID_IMAGE_SIZE",
                                      "INVALID_SAMPLER",
                                      "INVALID_BINARY",
                                      "INVALID_BUILD_OPTIONS",
                                      "INVALID_PROGRAM",
                                      "INVALID_PROGRAM_EXECUTABLE",
                                      "INVALID_KERNEL_NAME",
                                      "INVALID_KERNEL_DEFINITION",
                                      "INVALID_KERNEL",
                                      "INVALID_ARG_INDEX",
                                      "INVALID_ARG_VALUE",
                                      "INVALID_ARG_SIZE",
                                      "INVALID_KERNEL_ARGS",
                                      "INVALID_WORK_DIMENSION",
                                      "INVALID_WORK_GROUP_SIZE",
                                      "INVALID_WORK_ITEM_SIZE",
                                      "INVALID_GLOBAL_OFFSET",
                                      "INVALID_EVENT_WAIT_LIST",
                                      "INVALID_EVENT",
                                      "INVALID_OPERATION",
                                      "INVALID_GL_OBJECT",
                                      "INVALID_BUFFER_SIZE",
                                      "INVALID_MIP_LEVEL",
                                      "INVALID_GLOBAL_WORK_SIZE",
                                      "INVALID_PROPERTY",
                                      "INVALID_IMAGE_DESCRIPTOR",
                                      "INVALID_COMPILER_OPTIONS",
                                      "INVALID_LINKER_OPTIONS",
                                      "INVALID_DEVICE_PARTITION_COUNT"};
static_assert(CL_KERNEL_ARG_INFO_NOT_AVAILABLE == 1 - static_cast<int>(names_from_0.size()) &&
              CL_INVALID_DEVICE_PARTITION_COUNT == -29 - static_cast<int>(names_from_30.size()));

}  // namespace

std::string status_name(int status) {
  const std::size_t code = -static_cast<std::int64_t>(status);
  const char* name = nullptr;
  if (code < names_from_0.size()) name = names_from_0[code];
  if (code - 30 < names_from_30.size()) name = names_from_30[code - 30];
  if (status == -1001) name = "PLATFORM_NOT_FOUND_KHR";  // of the loader (cl_khr_icd)
  return name ? fmt::format("CL_{} ({})", name, status)
              : fmt::format("unknown status ({})", status);
}

std::string failure_text(std::string_view call, int status) {
  // A buffer may be too large for a device that has memory left.
  const bool no_memory = is_out_of_memory(status) && status != CL_INVALID_BUFFER_SIZE;
  return fmt::format("{} failed: {}{}", call, no_memory ? "out of memory, " : "",
                     status_name(status));
}

bool is_out_of_memory(int status) {
  return status == CL_MEM_OBJECT_ALLOCATION_FAILURE || status == CL_OUT_OF_RESOURCES ||
         status == CL_OUT_OF_HOST_MEMORY || status == CL_INVALID_BUFFER_SIZE;
}

void throw_status(cl_int status, std::string_view call, std::string_view detail) {
  throw DeviceError(
      fmt::format("{}{}{}", failure_text(call, status), detail.empty() ? "" : "; ", detail),
      status);
}

std::string device_text(cl_device_id device, cl_device_info name) {
  // Drivers pad with blanks, too.
  return std::string(trimmed(text_of(
      "clGetDeviceInfo", [&](auto... to) { return clGetDeviceInfo(device, name, to...); })));
}

std::string platform_text(cl_platform_id platform, cl_platform_info name) {
  return std::string(trimmed(text_of(
      "clGetPlatformInfo", [&](auto... to) { return clGetPlatformInfo(platform, name, to...); })));
}

}  // namespace photile::device
