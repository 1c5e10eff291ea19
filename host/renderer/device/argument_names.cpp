#include "device/argument_names.hpp"

#include <sstream>

namespace photile::device {
namespace {

constexpr std::string_view format_line = "arguments 1";

/// Takes a line off the text, without its end; none where there is no whole line.
std::optional<std::string_view> take_line(std::string_view& text) {
  const auto end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// What the runtime wrote, without the end of a C string.
std::string text_of(const std::string& written) { return written.c_str(); }

}  // namespace

std::optional<std::vector<std::string>> argument_names(cl_kernel kernel) {
  cl_uint count = 0;
  check(clGetKernelInfo(kernel, CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr),
        "clGetKernelInfo");
  std::vector<std::string> names;
  for (cl_uint i = 0; i < count; ++i) {
    std::size_t bytes = 0;
    if (clGetKernelArgInfo(kernel, i, CL_KERNEL_ARG_NAME, 0, nullptr, &bytes) != CL_SUCCESS ||
        bytes < 2) {
      return std::nullopt;
    }
    std::string name(bytes, '\0');
    check(clGetKernelArgInfo(kernel, i, CL_KERNEL_ARG_NAME, bytes, name.data(), nullptr),
          "clGetKernelArgInfo");
    names.push_back(text_of(name));
  }
  return names;
}

std::optional<ArgumentNames> argument_names(cl_program program) {
  cl_uint count = 0;
  check(clCreateKernelsInProgram(program, 0, nullptr, &count), "clCreateKernelsInProgram");
  std::vector<cl_kernel> created(count);
  check(clCreateKernelsInProgram(program, count, created.data(), nullptr),
        "clCreateKernelsInProgram");
  const std::vector<KernelHandle> kernels(created.begin(), created.end());
  ArgumentNames names;
  for (const KernelHandle& kernel : kernels) {
    std::size_t bytes = 0;
    check(clGetKernelInfo(kernel.get(), CL_KERNEL_FUNCTION_NAME, 0, nullptr, &bytes),
          "clGetKernelInfo");
    std::string name(bytes, '\0');
    check(clGetKernelInfo(kernel.get(), CL_KERNEL_FUNCTION_NAME, bytes, name.data(), nullptr),
          "clGetKernelInfo");
    auto arguments = argument_names(kernel.get());
    if (!arguments) return std::nullopt;
    names.emplace(text_of(name), std::move(*arguments));
  }
  return names;
}

std::string joined(const NamedBinary& program) {
  std::string text(format_line);
  text += '\n';
  for (const auto& [kernel, arguments] : program.arguments) {
    text += kernel;
    for (const std::string& argument : arguments) text += ' ' + argument;
    text += '\n';
  }
  return text + '\n' + program.binary;
}

std::optional<NamedBinary> split(std::string_view text) {
  if (take_line(text) != format_line) return std::nullopt;
  NamedBinary program;
  for (;;) {
    const auto line = take_line(text);
    if (!line) return std::nullopt;
    if (line->empty()) break;
    std::istringstream words{std::string(*line)};
    std::string kernel;
    words >> kernel;
    auto& arguments = program.arguments[kernel];
    for (std::string argument; words >> argument;) arguments.push_back(argument);
  }
  program.binary = text;
  return program;
}

}  // namespace photile::device
