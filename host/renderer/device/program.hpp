// Building one OpenCL program, the names of its kernels' arguments, and a dump of what was
// compiled.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/opencl.hpp"
#include "photile/device.hpp"

namespace photile::device {

/// The names of a kernel's arguments, in their order; none where the runtime does not report them.
std::optional<std::vector<std::string>> argument_names(cl_kernel kernel);

/// The names of the arguments of each kernel of a program, by its name.
using ArgumentNames = std::map<std::string, std::vector<std::string>>;
std::optional<ArgumentNames> argument_names(cl_program program);

/// Whether this thread is in a device's compiler, through which no exception may pass: its locks
/// would stay held.
bool in_compiler();

/// Sets the handler for an abort of the process, from the first compilation on: compilers of
/// devices replace the signal's handler when they are loaded.
void handle_aborts_by(void (*handler)(int));

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
ProgramHandle build_from_binary(const BuildTarget& target, const std::vector<std::uint8_t>& binary,
                                const std::string& options);

/// The program's binary; none where the runtime has none to give.
std::optional<std::string> program_binary(cl_program program);

/// Environment variable that names a folder. Each program that is built or loaded is written there:
/// NAME.cl, its source with all includes in place; NAME.options, the options of the compiler; and
/// NAME.bin, the binary, where the runtime gives one.
inline constexpr const char* dump_folder_variable = "PHOTILE_DUMP_KERNELS";

/// Writes a program where the variable is set; NAME is that of the kernel file and a number that
/// differs for other options. Errors: OutputError.
void dump_program(const std::string& file, const std::string& options, cl_program program);

}  // namespace photile::device
