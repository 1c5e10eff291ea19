// The names of the arguments of kernels, which OpenCL promises for programs made from source only:
// with a binary they are kept beside it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/opencl.hpp"

namespace photile::device {

/// The names of a kernel's arguments, in their order; none where the runtime does not tell them.
std::optional<std::vector<std::string>> argument_names(cl_kernel kernel);

/// The names of the arguments of each kernel of a program, by its name.
using ArgumentNames = std::map<std::string, std::vector<std::string>>;
std::optional<ArgumentNames> argument_names(cl_program program);

struct NamedBinary {
  ArgumentNames arguments;
  std::string binary;
};

/// Names and binary as one text: a line for the format, one for each kernel, an empty one, the
/// binary.
std::string joined(const NamedBinary& program);
/// What `joined` made; none of any other text.
std::optional<NamedBinary> split(std::string_view text);

}  // namespace photile::device
