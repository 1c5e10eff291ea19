#include "device/opencl.hpp"

#include <fmt/format.h>

#include "device/status_names.hpp"
#include "photile/errors.hpp"

namespace photile::device {
namespace {

/// A runtime's text, without its terminating zero and without blanks at either end (drivers pad).
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  text.erase(0, text.find_first_not_of(' '));
  return text;
}

}  // namespace

void throw_status(cl_int status, std::string_view call, std::string_view detail) {
  throw DeviceError(fmt::format("{} failed: {}{}{}", call, status_name(status),
                                detail.empty() ? "" : "; ", detail),
                    status);
}

std::string device_text(cl_device_id device, cl_device_info name) {
  std::size_t bytes = 0;
  check(clGetDeviceInfo(device, name, 0, nullptr, &bytes), "clGetDeviceInfo");
  std::string text(bytes, '\0');
  check(clGetDeviceInfo(device, name, bytes, text.data(), nullptr), "clGetDeviceInfo");
  return trimmed(std::move(text));
}

std::string platform_text(cl_platform_id platform, cl_platform_info name) {
  std::size_t bytes = 0;
  check(clGetPlatformInfo(platform, name, 0, nullptr, &bytes), "clGetPlatformInfo");
  std::string text(bytes, '\0');
  check(clGetPlatformInfo(platform, name, bytes, text.data(), nullptr), "clGetPlatformInfo");
  return trimmed(std::move(text));
}

}  // namespace photile::device
