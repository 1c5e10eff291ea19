// The kernels of one program.
#pragma once

#include <string>
#include <utility>

#include "device/context.hpp"
#include "device/launch.hpp"

namespace photile::device {

/// A kernel file and the definitions that it is built with, on one context.
class KernelSet {
 public:
  KernelSet(Context& context, std::string file, Defines defines)
      : context_(&context), file_(std::move(file)), defines_(std::move(defines)) {}

  Context& context() const { return *context_; }
  /// The kernel of a name: see Context::kernel.
  Kernel kernel(const std::string& name) const { return context_->kernel(file_, name, defines_); }
  /// A launch of a kernel of the set.
  Launch launch(const std::string& name) const { return {*context_, kernel(name)}; }

 private:
  Context* context_;
  std::string file_;
  Defines defines_;
};

}  // namespace photile::device
