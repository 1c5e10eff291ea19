// OpenCL status codes, by name.
#pragma once

#include <string>

namespace photile::device {

/// "CL_OUT_OF_RESOURCES (-5)"; "unknown status (-12345)" for a code that OpenCL 1.2 does not
/// define.
std::string status_name(int status);

/// True for the codes by which a runtime says that memory ran out or a buffer is too large.
bool is_out_of_memory(int status);

}  // namespace photile::device
