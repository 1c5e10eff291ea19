// Kernels: creation, arguments, launches.
#include <fmt/format.h>

#include <mutex>

#include "device/context_impl.hpp"
#include "photile/statistics.hpp"

namespace photile::device {
namespace {

/// Kernels step over their items by the number of work-items, in 32 bits: the index of an item and
/// one step must not wrap.
constexpr std::size_t max_work_items = std::size_t{1} << 31;

/// Held while PoCL compiles for one of several devices: two threads of a process that compile the
/// same kernel at the same time crash PoCL 3.1 once in a while.
std::unique_lock<std::mutex> lock_compilation(bool is_pocl) {
  static std::mutex mutex;
  const bool alone = LiveContext::count() < 2;
  return is_pocl && !alone ? std::unique_lock(mutex) : std::unique_lock<std::mutex>();
}

}  // namespace

Kernel Context::kernel(const std::string& file, const std::string& name, const Defines& defines) {
  const auto options = defines.options();
  const auto key = std::make_tuple(file, name, options);
  if (const auto found = impl_->kernels.find(key); found != impl_->kernels.end()) {
    return found->second;
  }
  const auto compiling = lock_compilation(impl_->info.is_pocl);
  auto made = std::make_shared<Kernel::Impl>();
  const cl_program program = impl_->programs->get(file, options);
  const Stopwatch stopwatch;
  const cl_int status = impl_->persevere([&] {
    cl_int created = CL_SUCCESS;
    made->kernel = KernelHandle(clCreateKernel(program, name.c_str(), &created));
    return created;
  });
  impl_->check(status, "clCreateKernel", fmt::format("kernel '{}' of '{}'", name, file));
  made->name = name;
  cl_uint count = 0;
  impl_->check(
      clGetKernelInfo(made->kernel.get(), CL_KERNEL_NUM_ARGS, sizeof count, &count, nullptr),
      "clGetKernelInfo", name);
  made->argument_count = count;
  if (impl_->profile) impl_->times.add_preparation(name, stopwatch.seconds());
  return impl_->kernels.emplace(key, Kernel(std::move(made))).first->second;
}

void Context::set_buffer_argument(const Kernel& kernel, unsigned index, const RawBuffer& buffer) {
  void* const memory = buffer.handle();
  set_value_argument(kernel, index, &memory, sizeof memory);
}

void Context::set_value_argument(const Kernel& kernel, unsigned index, const void* value,
                                 std::size_t bytes) {
  const auto& impl = kernel.impl();
  const cl_int status =
      impl_->persevere([&] { return clSetKernelArg(impl.kernel.get(), index, bytes, value); });
  if (status != CL_SUCCESS) {
    impl_->check(status, "clSetKernelArg",
                 fmt::format("argument {} of kernel '{}', {} bytes", index, impl.name, bytes));
  }
}

void Context::enqueue(const Kernel& kernel, unsigned argument_count, std::size_t global_size,
                      std::size_t local_size) {
  auto& impl = kernel.impl();
  if (argument_count != impl.argument_count) {
    throw DeviceError(fmt::format("kernel '{}' takes {} arguments, {} given", impl.name,
                                  impl.argument_count, argument_count),
                      CL_INVALID_KERNEL_ARGS);
  }
  if (global_size == 0) return;
  if (local_size != 0) global_size = (global_size + local_size - 1) / local_size * local_size;
  if (global_size > max_work_items) {
    throw DeviceError(fmt::format("kernel '{}' is to run on {} work-items; at most {} can be",
                                  impl.name, global_size, max_work_items),
                      CL_INVALID_GLOBAL_WORK_SIZE);
  }
  // A runtime may compile within the first launch: it is timed alone, and in PoCL waited for.
  const bool prepares = !impl.launched;
  const auto compiling = lock_compilation(prepares && impl_->info.is_pocl);
  const bool time_preparation = impl_->profile && prepares;
  if (time_preparation) finish();
  const Stopwatch stopwatch;
  cl_event event = nullptr;
  const cl_int status = impl_->persevere([&] {
    return clEnqueueNDRangeKernel(impl_->queue.get(), impl.kernel.get(), 1, nullptr, &global_size,
                                  local_size == 0 ? nullptr : &local_size, 0, nullptr,
                                  impl_->profile ? &event : nullptr);
  });
  if (status != CL_SUCCESS) {
    impl_->check(status, "clEnqueueNDRangeKernel",
                 fmt::format("kernel '{}', {} work-items in groups of {}", impl.name, global_size,
                             local_size));
  }
  impl.launched = true;
  if (compiling.owns_lock()) finish();
  if (!impl_->profile) return;
  EventHandle owned(event);
  if (time_preparation) {
    finish();
    impl_->times.add_first(impl.name, std::move(owned), stopwatch.seconds());
  } else {
    impl_->times.add(impl.name, std::move(owned));
  }
}

}  // namespace photile::device
