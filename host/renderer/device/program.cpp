#include "device/program.hpp"

#include <fmt/format.h>

#include "device/opencl.hpp"
#include "photile/errors.hpp"

namespace photile::device {
namespace {

std::string build_log(cl_program program, cl_device_id device) {
  std::size_t bytes = 0;
  if (clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &bytes) !=
      CL_SUCCESS) {
    return {};
  }
  std::string log(bytes, '\0');
  clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, bytes, log.data(), nullptr);
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

/// The first line of a log that speaks of an error, else its first line: a message is one line.
std::string first_error(const std::string& log) {
  auto at = log.find("error");
  if (at == std::string::npos) at = 0;
  const auto begin = at == 0 ? 0 : log.rfind('\n', at) + 1;  // npos + 1 is the log's begin
  return log.substr(begin, log.find('\n', at) - begin);
}

}  // namespace

std::string base_options(cl_device_id device) {
  std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info";
  const auto single = device_property<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
  if (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
    options += " -cl-fp32-correctly-rounded-divide-sqrt";
  }
  return options;
}

ProgramHandle build_from_source(const BuildTarget& target, const std::string& file,
                                const std::string& source, const std::string& options) {
  const char* text = source.c_str();
  const std::size_t length = source.size();
  cl_int status = CL_SUCCESS;
  ProgramHandle program(clCreateProgramWithSource(target.context, 1, &text, &length, &status));
  check(status, "clCreateProgramWithSource", file);
  status = clBuildProgram(program.get(), 1, &target.device, options.c_str(), nullptr, nullptr);
  if (status != CL_SUCCESS) {
    const auto log = build_log(program.get(), target.device);
    throw KernelBuildError(
        fmt::format("kernel file '{}' does not build on '{}' (driver {}, options '{}'): {}: {}",
                    file, target.info->name, target.info->driver_version, options,
                    status_name(status), first_error(log)),
        log, status);
  }
  return program;
}

ProgramHandle build_from_binary(const BuildTarget& target, const std::string& binary,
                                const std::string& options) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
  const std::size_t length = binary.size();
  cl_int status = CL_SUCCESS, binary_status = CL_SUCCESS;
  ProgramHandle program(clCreateProgramWithBinary(target.context, 1, &target.device, &length,
                                                  &bytes, &binary_status, &status));
  if (status != CL_SUCCESS || binary_status != CL_SUCCESS) return {};
  status = clBuildProgram(program.get(), 1, &target.device, options.c_str(), nullptr, nullptr);
  return status == CL_SUCCESS ? std::move(program) : ProgramHandle{};
}

std::optional<std::string> program_binary(cl_program program) {
  std::size_t length = 0;
  if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof length, &length, nullptr) !=
          CL_SUCCESS ||
      length == 0) {
    return std::nullopt;
  }
  std::string binary(length, '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(binary.data());
  if (clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof bytes, &bytes, nullptr) != CL_SUCCESS) {
    return std::nullopt;
  }
  return binary;
}

}  // namespace photile::device
