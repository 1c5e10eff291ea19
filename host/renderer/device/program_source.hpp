// Kernel sources: found by name, their includes resolved.
#pragma once

#include <string>
#include <string_view>

namespace photile::device {

/// Environment variable that names a folder with the layout of kernels/. A file found there
/// replaces the embedded or registered one of that name: for work on kernels without a rebuild. A
/// folder without any such file is a UsageError.
inline constexpr const char* kernel_folder_variable = "PHOTILE_KERNEL_DIR";

/// The text of kernel file `file` with every `#include "path"` line replaced by that file's text,
/// the first time that it is included. A file that is included under a condition of the
/// preprocessor is present only where that condition holds: no later file may include it
/// unconditionally. Paths are below kernels/, or "photile/device/<name>.h". `#line` markers keep
/// the names and lines of build errors right; `#include <...>` lines stay. Errors: KernelBuildError
/// for an unknown file, naming who included it.
std::string assemble_source(const std::string& file);

/// Makes `text` known as kernel file `name`, before any embedded one of that name: kernels that the
/// library does not use, of benches and tests.
void register_kernel_source(const std::string& name, std::string text);

}  // namespace photile::device
