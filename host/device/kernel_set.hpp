// The kernels of one program.
#pragma once

#include <string>
#include <utility>

#include "device/context.hpp"

namespace photile::device {

/// A kernel file and the definitions that it is built with, on one context.
class KernelSet {
 public:
  KernelSet(Context& context, std::string file, Defines defines)
      : context_(&context), file_(std::move(file)), defines_(std::move(defines)) {}

  Context& context() const { return *context_; }
  /// As Context::kernel.
  Kernel kernel(const std::string& name) const { return context_->kernel(file_, name, defines_); }
  /// As Context::run.
  template <class... Args>
  void run(const char* name, std::size_t global_size, std::size_t local_size,
           const Args&... args) const {
    context_->run(kernel(name), global_size, local_size, args...);
  }

 private:
  Context* context_;
  std::string file_;
  Defines defines_;
};

}  // namespace photile::device
