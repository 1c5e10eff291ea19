#include "device/opencl.hpp"

#include <fmt/format.h>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::device {
namespace {

const char* name_of(int status) {
#define PHOTILE_STATUS(code) \
  case code:                 \
    return #code;
  switch (status) {
    PHOTILE_STATUS(CL_SUCCESS)
    PHOTILE_STATUS(CL_DEVICE_NOT_FOUND)
    PHOTILE_STATUS(CL_DEVICE_NOT_AVAILABLE)
    PHOTILE_STATUS(CL_COMPILER_NOT_AVAILABLE)
    PHOTILE_STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE)
    PHOTILE_STATUS(CL_OUT_OF_RESOURCES)
    PHOTILE_STATUS(CL_OUT_OF_HOST_MEMORY)
    PHOTILE_STATUS(CL_PROFILING_INFO_NOT_AVAILABLE)
    PHOTILE_STATUS(CL_MEM_COPY_OVERLAP)
    PHOTILE_STATUS(CL_IMAGE_FORMAT_MISMATCH)
    PHOTILE_STATUS(CL_IMAGE_FORMAT_NOT_SUPPORTED)
    PHOTILE_STATUS(CL_BUILD_PROGRAM_FAILURE)
    PHOTILE_STATUS(CL_MAP_FAILURE)
    PHOTILE_STATUS(CL_MISALIGNED_SUB_BUFFER_OFFSET)
    PHOTILE_STATUS(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)
    PHOTILE_STATUS(CL_COMPILE_PROGRAM_FAILURE)
    PHOTILE_STATUS(CL_LINKER_NOT_AVAILABLE)
    PHOTILE_STATUS(CL_LINK_PROGRAM_FAILURE)
    PHOTILE_STATUS(CL_DEVICE_PARTITION_FAILED)
    PHOTILE_STATUS(CL_KERNEL_ARG_INFO_NOT_AVAILABLE)
    PHOTILE_STATUS(CL_INVALID_VALUE)
    PHOTILE_STATUS(CL_INVALID_DEVICE_TYPE)
    PHOTILE_STATUS(CL_INVALID_PLATFORM)
    PHOTILE_STATUS(CL_INVALID_DEVICE)
    PHOTILE_STATUS(CL_INVALID_CONTEXT)
    PHOTILE_STATUS(CL_INVALID_QUEUE_PROPERTIES)
    PHOTILE_STATUS(CL_INVALID_COMMAND_QUEUE)
    PHOTILE_STATUS(CL_INVALID_HOST_PTR)
    PHOTILE_STATUS(CL_INVALID_MEM_OBJECT)
    PHOTILE_STATUS(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR)
    PHOTILE_STATUS(CL_INVALID_IMAGE_SIZE)
    PHOTILE_STATUS(CL_INVALID_SAMPLER)
    PHOTILE_STATUS(CL_INVALID_BINARY)
    PHOTILE_STATUS(CL_INVALID_BUILD_OPTIONS)
    PHOTILE_STATUS(CL_INVALID_PROGRAM)
    PHOTILE_STATUS(CL_INVALID_PROGRAM_EXECUTABLE)
    PHOTILE_STATUS(CL_INVALID_KERNEL_NAME)
    PHOTILE_STATUS(CL_INVALID_KERNEL_DEFINITION)
    PHOTILE_STATUS(CL_INVALID_KERNEL)
    PHOTILE_STATUS(CL_INVALID_ARG_INDEX)
    PHOTILE_STATUS(CL_INVALID_ARG_VALUE)
    PHOTILE_STATUS(CL_INVALID_ARG_SIZE)
    PHOTILE_STATUS(CL_INVALID_KERNEL_ARGS)
    PHOTILE_STATUS(CL_INVALID_WORK_DIMENSION)
    PHOTILE_STATUS(CL_INVALID_WORK_GROUP_SIZE)
    PHOTILE_STATUS(CL_INVALID_WORK_ITEM_SIZE)
    PHOTILE_STATUS(CL_INVALID_GLOBAL_OFFSET)
    PHOTILE_STATUS(CL_INVALID_EVENT_WAIT_LIST)
    PHOTILE_STATUS(CL_INVALID_EVENT)
    PHOTILE_STATUS(CL_INVALID_OPERATION)
    PHOTILE_STATUS(CL_INVALID_GL_OBJECT)
    PHOTILE_STATUS(CL_INVALID_BUFFER_SIZE)
    PHOTILE_STATUS(CL_INVALID_MIP_LEVEL)
    PHOTILE_STATUS(CL_INVALID_GLOBAL_WORK_SIZE)
    PHOTILE_STATUS(CL_INVALID_PROPERTY)
    PHOTILE_STATUS(CL_INVALID_IMAGE_DESCRIPTOR)
    PHOTILE_STATUS(CL_INVALID_COMPILER_OPTIONS)
    PHOTILE_STATUS(CL_INVALID_LINKER_OPTIONS)
    PHOTILE_STATUS(CL_INVALID_DEVICE_PARTITION_COUNT)
    case -1001:  // of the loader (cl_khr_icd), not of OpenCL
      return "CL_PLATFORM_NOT_FOUND_KHR";
    default:
      return "unknown status";
  }
#undef PHOTILE_STATUS
}

}  // namespace

std::string status_name(int status) { return fmt::format("{} ({})", name_of(status), status); }

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
