// Errors as exceptions.
#pragma once

#include <stdexcept>
#include <string>

namespace photile {

/// Base of every error photile throws on purpose. `what()` is one line: the file or object, what
/// was found, and the remedy.
struct Error : std::runtime_error {
  /// Line ends and other control characters of the message, which names in files may hold, become
  /// blanks.
  explicit Error(const std::string& message);
};

/// A parameter is out of its range, or names something that does not exist.
struct UsageError : Error {
  using Error::Error;
};

/// A file, or a scene made in memory, cannot be used.
struct InputError : Error {
  using Error::Error;
};

/// An output cannot be written.
struct OutputError : Error {
  using Error::Error;
};

/// An OpenCL call failed. Carries the status by name and the call that returned it.
struct DeviceError : Error {
  explicit DeviceError(const std::string& message, int status = 0)
      : Error(message), status(status) {}
  int status;  ///< the OpenCL status code, 0 where none applies
};

/// The device's memory, or the part of it that may be used, does not suffice. Work in batches is
/// tried again with smaller batches.
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
  Interrupted() : Error("interrupted") {}
};

}  // namespace photile
