#include "device/program.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "common/files.hpp"
#include "device/cache_folder.hpp"
#include "device/opencl.hpp"
#include "device/program_source.hpp"
#include "photile/errors.hpp"

namespace photile::device {

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
    names.push_back(text_of("clGetKernelArgInfo", [&](auto... to) {
      return clGetKernelArgInfo(kernel, i, CL_KERNEL_ARG_NAME, to...);
    }));
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
    auto arguments = argument_names(kernel.get());
    if (!arguments) return std::nullopt;
    names.emplace(text_of("clGetKernelInfo",
                          [&](auto... to) {
                            return clGetKernelInfo(kernel.get(), CL_KERNEL_FUNCTION_NAME, to...);
                          }),
                  std::move(*arguments));
  }
  return names;
}

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
  std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info -w";
  const auto single = device_property<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
  if (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
    options += " -cl-fp32-correctly-rounded-divide-sqrt";
  }
  return options;
}

namespace {

thread_local bool compiling = false;
void (*abort_handler)(int) = nullptr;

/// Reports a compilation that takes a minute, during which the user sees nothing else.
class SlowCompilation {
 public:
  explicit SlowCompilation(const DeviceInfo& info) {
    try {
      teller_ = std::thread([this, name = info.name] { wait(name); });
    } catch (const std::system_error&) {  // no thread can be started: nothing is printed
    }
  }
  ~SlowCompilation() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    over_.notify_one();
    if (teller_.joinable()) teller_.join();
  }
  SlowCompilation(const SlowCompilation&) = delete;
  SlowCompilation& operator=(const SlowCompilation&) = delete;

 private:
  void wait(const std::string& device) {
    std::unique_lock lock(mutex_);
    if (over_.wait_for(lock, std::chrono::minutes(1), [this] { return is_over_; })) return;
    warn(fmt::format(
        "'{}' has been compiling a kernel for a minute; fewer neighbours (-k), another device "
        "(--device) or a newer driver may be faster; the compiled kernel is cached",
        device));
  }

  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread teller_;
};

cl_int build(cl_program program, const BuildTarget& target, const std::string& options) {
  const SlowCompilation watched(*target.info);
  if (abort_handler != nullptr) std::signal(SIGABRT, abort_handler);
  compiling = true;
  const cl_int status =
      clBuildProgram(program, 1, &target.device, options.c_str(), nullptr, nullptr);
  compiling = false;
  return status;
}

}  // namespace

bool in_compiler() { return compiling; }

void handle_aborts_by(void (*handler)(int)) { abort_handler = handler; }

ProgramHandle build_from_source(const BuildTarget& target, const std::string& file,
                                const std::string& source, const std::string& options) {
  const char* text = source.c_str();
  const std::size_t length = source.size();
  cl_int status = CL_SUCCESS;
  ProgramHandle program(clCreateProgramWithSource(target.context, 1, &text, &length, &status));
  check(status, "clCreateProgramWithSource", file);
  status = build(program.get(), target, options);
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

ProgramHandle build_from_binary(const BuildTarget& target, const std::vector<std::uint8_t>& binary,
                                const std::string& options) {
  const unsigned char* bytes = binary.data();
  const std::size_t length = binary.size();
  cl_int status = CL_SUCCESS, binary_status = CL_SUCCESS;
  ProgramHandle program(clCreateProgramWithBinary(target.context, 1, &target.device, &length,
                                                  &bytes, &binary_status, &status));
  if (status != CL_SUCCESS || binary_status != CL_SUCCESS) return {};
  status = build(program.get(), target, options);
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

void dump_program(const std::string& file, const std::string& options, cl_program program) {
  const char* const variable = std::getenv(dump_folder_variable);
  if (variable == nullptr || *variable == '\0') return;
  const std::filesystem::path folder = variable;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: {}", folder.string(), error.message()));

  std::string name = file.substr(0, file.rfind('.'));
  std::replace(name.begin(), name.end(), '/', '-');
  const std::filesystem::path path =
      folder / fmt::format("{}-{:08x}", name, XXH32(options.data(), options.size(), 0));
  write_file(path.string() + ".cl", assemble_source(file));
  write_file(path.string() + ".options", options + "\n");
  if (const auto binary = program_binary(program)) write_file(path.string() + ".bin", *binary);
}

}  // namespace photile::device
