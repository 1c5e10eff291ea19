// The OpenCL C API as host/renderer/device uses it: version, owning handles, status checks,
// queries.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS  // clCreateCommandQueue: its successor is OpenCL 2.0
#include <CL/cl.h>
#include <CL/cl_ext.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace photile::device {

/// "CL_OUT_OF_RESOURCES (-5)"; "unknown status (-12345)" for a code that OpenCL 1.2 does not
/// define.
std::string status_name(int status);

/// "clFinish failed: out of memory, CL_OUT_OF_RESOURCES (-5)".
std::string failure_text(std::string_view call, int status);

/// True for the codes by which a runtime reports that memory ran out or a buffer is too large.
bool is_out_of_memory(int status);

/// Throws DeviceError "<call> failed: <status by name>; <detail>".
[[noreturn]] void throw_status(cl_int status, std::string_view call, std::string_view detail = {});

/// Throws as `throw_status` unless `status` is CL_SUCCESS.
inline void check(cl_int status, std::string_view call, std::string_view detail = {}) {
  if (status != CL_SUCCESS) throw_status(status, call, detail);
}

/// Owns one reference to an OpenCL object. A failing release is ignored: nothing can be done.
template <class T, cl_int (*release)(T)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Handle() {
    if (object_ != nullptr) release(object_);
  }
  T get() const { return object_; }
  /// Gives the reference away: the caller releases it.
  T detach() { return std::exchange(object_, nullptr); }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  T object_ = nullptr;
};

/// Only sub-devices are counted: a device that a platform lists is never released.
using SubDeviceHandle = Handle<cl_device_id, clReleaseDevice>;
using MemoryHandle = Handle<cl_mem, clReleaseMemObject>;
using ContextHandle = Handle<cl_context, clReleaseContext>;
using QueueHandle = Handle<cl_command_queue, clReleaseCommandQueue>;
using ProgramHandle = Handle<cl_program, clReleaseProgram>;
using KernelHandle = Handle<cl_kernel, clReleaseKernel>;
using EventHandle = Handle<cl_event, clReleaseEvent>;

/// A property of a device or platform. Errors: DeviceError.
template <class T>
T device_property(cl_device_id device, cl_device_info name) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  check(clGetDeviceInfo(device, name, sizeof value, &value, nullptr), "clGetDeviceInfo");
  return value;
}
/// A text from query(bytes, text, &bytes_needed), a function of the API. Errors: DeviceError that
/// names `call`.
template <class Query>
std::string text_of(std::string_view call, const Query& query) {
  std::size_t bytes = 0;
  check(query(std::size_t{0}, static_cast<char*>(nullptr), &bytes), call);
  std::string text(bytes, '\0');
  check(query(bytes, text.data(), static_cast<std::size_t*>(nullptr)), call);
  return text.c_str();  // without what pads it
}

std::string device_text(cl_device_id device, cl_device_info name);
std::string platform_text(cl_platform_id platform, cl_platform_info name);

}  // namespace photile::device
