// What can go wrong, as exceptions, and the exit code that the command line gives for each.
#pragma once

#include <stdexcept>
#include <string>

namespace photile {

/// The exit codes of the `photile` command. Documented in docs/command-line.md.
enum class ExitCode : int {
  success = 0,       ///< the output is complete
  failure = 1,       ///< run-time failure: unwritable output, disk full, internal error
  usage = 2,         ///< unknown option, value out of range, unknown light name
  input = 3,         ///< scene or image missing, unreadable, malformed, without lights or geometry
  device = 4,        ///< no OpenCL device, kernel build failure, device out of memory
  interrupted = 130  ///< stopped by the user (SIGINT); earlier results are kept
};

/// Base of every error photile throws on purpose. `what()` is one line: the file or object, what
/// was found, and the remedy.
class Error : public std::runtime_error {
 public:
  Error(ExitCode exit_code, const std::string& message)
      : std::runtime_error(message), exit_code_(exit_code) {}
  ExitCode exit_code() const noexcept { return exit_code_; }

 private:
  ExitCode exit_code_;
};

/// A parameter is out of its range, or names something that does not exist.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// A file given by the user cannot be used.
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(ExitCode::input, message) {}
};

/// An output cannot be written.
struct OutputError : Error {
  explicit OutputError(const std::string& message) : Error(ExitCode::failure, message) {}
};

/// An OpenCL call failed. Carries the status by name and the call that returned it.
struct DeviceError : Error {
  explicit DeviceError(const std::string& message, int status = 0)
      : Error(ExitCode::device, message), status(status) {}
  int status;  ///< the OpenCL status code, 0 where none applies
};

/// The device's memory, or the part of it that may be used, does not suffice. Whoever works in
/// batches tries again with smaller ones.
struct DeviceMemoryError : DeviceError {
  using DeviceError::DeviceError;
};

/// A kernel did not compile. The build log travels in the exception.
struct KernelBuildError : DeviceError {
  KernelBuildError(const std::string& message, std::string build_log, int status)
      : DeviceError(message, status), build_log(std::move(build_log)) {}
  std::string build_log;
};

/// The user asked to stop.
struct Interrupted : Error {
  Interrupted() : Error(ExitCode::interrupted, "interrupted") {}
};

}  // namespace photile
