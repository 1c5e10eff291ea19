// Building one OpenCL program.
#pragma once

#include <optional>
#include <string>

#include "device/opencl.hpp"
#include "photile/device.hpp"

namespace photile::device {

/// Where programs are built.
struct BuildTarget {
  cl_context context = nullptr;
  cl_device_id device = nullptr;
  const DeviceInfo* info = nullptr;
};

/// The options of every program: OpenCL C 1.2, no fast mathematics, and division and square root
/// rounded to nearest where the device offers that.
std::string base_options(cl_device_id device);

/// Builds `source`. `file` is named in the message. Errors: KernelBuildError with the log.
ProgramHandle build_from_source(const BuildTarget& target, const std::string& file,
                                const std::string& source, const std::string& options);

/// Builds a binary that `program_binary` gave; an empty handle where the device refuses it.
ProgramHandle build_from_binary(const BuildTarget& target, const std::string& binary,
                                const std::string& options);

/// The program's binary; none where the runtime has none to give.
std::optional<std::string> program_binary(cl_program program);

}  // namespace photile::device
