// What a device was given to compile, and what it made of it, for who works on kernels.
#pragma once

#include <string>

#include "device/opencl.hpp"

namespace photile::device {

/// Environment variable that names a folder. Each program that is built or loaded is written there:
/// NAME.cl, its source with all includes in place; NAME.options, the options of the compiler; and
/// NAME.bin, the binary, where the runtime gives one.
inline constexpr const char* dump_folder_variable = "PHOTILE_DUMP_KERNELS";

/// Writes a program where the variable is set; NAME is that of the kernel file and a number that
/// differs for other options. Errors: OutputError.
void dump_program(const std::string& file, const std::string& options, cl_program program);

}  // namespace photile::device
