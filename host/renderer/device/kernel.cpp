// Kernels: creation, arguments, launches.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>

#include "device/context_impl.hpp"
#include "device/launch.hpp"
#include "photile/statistics.hpp"

namespace photile::device {

namespace {

/// Kernels step over their items by the number of work-items, in 32 bits: the index of an item and
/// one step must not wrap.
constexpr std::size_t max_work_items = std::size_t{1} << 31;

/// For fewer work-items than this PoCL 3.1 compiles a separate version of the kernel for small
/// grids, and another for larger ones (docs/kernels/runtimes.md): idle work-items cost
/// microseconds, a version 60 ms.
constexpr std::size_t least_unspecialised = std::size_t{1} << 16;

/// Held while PoCL compiles: two threads of a process that compile the same kernel at the same time
/// crash PoCL 3.1 once in a while (docs/kernels/runtimes.md).
std::unique_lock<std::mutex> lock_compilation(bool is_pocl) {
  static std::mutex mutex;
  return is_pocl ? std::unique_lock(mutex) : std::unique_lock<std::mutex>();
}

template <class T>
T group_property(cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info name) {
  T value{};
  check(clGetKernelWorkGroupInfo(kernel, device, name, sizeof value, &value, nullptr),
        "clGetKernelWorkGroupInfo");
  return value;
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
  const Program& program = impl_->programs->get(file, options);
  const Stopwatch stopwatch;
  const cl_int status = impl_->persevere([&] {
    cl_int created = CL_SUCCESS;
    made->kernel = KernelHandle(clCreateKernel(program.handle.get(), name.c_str(), &created));
    return created;
  });
  impl_->check(status, "clCreateKernel", fmt::format("kernel '{}' of '{}'", name, file));
  auto arguments = argument_names(made->kernel.get());
  if (const auto kept = program.arguments.find(name);
      !arguments && kept != program.arguments.end()) {
    arguments = kept->second;
  }
  if (!arguments) {
    throw DeviceError(fmt::format("the device does not report the argument names of kernel '{}' of "
                                  "'{}'; update its driver",
                                  name, file),
                      CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
  }
  made->name = name;
  made->arguments = std::move(*arguments);
  const cl_kernel made_kernel = made->kernel.get();
  const cl_device_id device = impl_->device;
  made->resources = {group_property<cl_ulong>(made_kernel, device, CL_KERNEL_PRIVATE_MEM_SIZE),
                     group_property<cl_ulong>(made_kernel, device, CL_KERNEL_LOCAL_MEM_SIZE),
                     group_property<std::size_t>(made_kernel, device, CL_KERNEL_WORK_GROUP_SIZE)};
  made->required_group = group_property<std::array<std::size_t, 3>>(
      made_kernel, device, CL_KERNEL_COMPILE_WORK_GROUP_SIZE)[0];
  if (impl_->profile) impl_->times.add_preparation(name, stopwatch.seconds());
  return impl_->kernels.emplace(key, Kernel(std::move(made))).first->second;
}

const KernelResources& Kernel::resources() const { return impl_->resources; }

Launch::Launch(Context& context, Kernel kernel)
    : context_(context),
      kernel_(std::move(kernel)),
      is_set_(kernel_.impl().arguments.size(), false) {}

Launch& Launch::set_bytes(std::string_view name, const void* value, std::size_t bytes) {
  const auto& kernel = kernel_.impl();
  const auto found = std::find(kernel.arguments.begin(), kernel.arguments.end(), name);
  if (found == kernel.arguments.end()) {
    throw DeviceError(fmt::format("kernel '{}' has no argument '{}'", kernel.name, name),
                      CL_INVALID_ARG_INDEX);
  }
  const auto index = static_cast<cl_uint>(found - kernel.arguments.begin());
  const cl_int status = context_.impl_->persevere(
      [&] { return clSetKernelArg(kernel.kernel.get(), index, bytes, value); });
  if (status != CL_SUCCESS) {
    context_.impl_->check(
        status, "clSetKernelArg",
        fmt::format("argument '{}' of kernel '{}', {} bytes", name, kernel.name, bytes));
  }
  is_set_[index] = true;
  return *this;
}

void Launch::run(std::size_t global_size, std::size_t local_size) {
  const DeviceInfo& info = context_.info();
  const bool specialises = info.is_pocl && local_size > 0;
  if (global_size > 0 && specialises) global_size = std::max(global_size, least_unspecialised);
  enqueue(global_size, local_size);
}

void Launch::run_no_more(std::size_t global_size, std::size_t local_size) {
  enqueue(global_size, local_size);
}

void Launch::enqueue(std::size_t global_size, std::size_t local_size) {
  auto& impl = kernel_.impl();
  auto& context = *context_.impl_;
  const auto unset = std::find(is_set_.begin(), is_set_.end(), false);
  if (unset != is_set_.end()) {
    throw DeviceError(fmt::format("kernel '{}' is not given its argument '{}'", impl.name,
                                  impl.arguments[unset - is_set_.begin()]),
                      CL_INVALID_KERNEL_ARGS);
  }
  if (global_size == 0) return;
  const KernelResources& resources = impl.resources;
  if (resources.local_bytes > context.info.local_memory_bytes) {
    throw DeviceError(
        fmt::format(
            "kernel '{}' needs {} bytes of local memory, but '{}' has {}; use another device",
            impl.name, resources.local_bytes, context.info.name, context.info.local_memory_bytes),
        CL_OUT_OF_RESOURCES);
  }
  if (local_size > resources.largest_group) {
    if (impl.required_group != 0 || resources.largest_group == 0) {
      throw DeviceError(
          fmt::format("kernel '{}' needs work-groups of {}, but '{}' runs at most {} work-items of "
                      "it together; use another device",
                      impl.name, local_size, context.info.name, resources.largest_group),
          CL_INVALID_WORK_GROUP_SIZE);
    }
    local_size = std::bit_floor(resources.largest_group);
  }
  if (local_size != 0) global_size = (global_size + local_size - 1) / local_size * local_size;
  if (global_size > max_work_items) {
    throw DeviceError(fmt::format("kernel '{}': {} work-items; the limit is {}", impl.name,
                                  global_size, max_work_items),
                      CL_INVALID_GLOBAL_WORK_SIZE);
  }
  // A runtime may compile within the first launch: it is timed alone, and in PoCL waited for.
  const bool prepares = !impl.launched;
  const auto compiling = lock_compilation(prepares && context.info.is_pocl);
  const bool time_preparation = context.profile && prepares;
  if (time_preparation) context_.finish();
  const Stopwatch stopwatch;
  cl_event event = nullptr;
  const auto launch = [&] {
    return clEnqueueNDRangeKernel(context.queue.get(), impl.kernel.get(), 1, nullptr, &global_size,
                                  local_size == 0 ? nullptr : &local_size, 0, nullptr,
                                  context.profile ? &event : nullptr);
  };
  cl_int status = launch();
  if (status == CL_OUT_OF_RESOURCES) {  // registers or local memory: releasing buffers is no help
    clFinish(context.queue.get());
    status = launch();
  } else if (is_out_of_memory(status)) {
    status = context.persevere(launch);
  }
  if (status == CL_OUT_OF_RESOURCES) {
    throw_status(status, "clEnqueueNDRangeKernel",
                 fmt::format("kernel '{}' in groups of {} asks for more registers or local memory "
                             "than '{}' has, or the device is lost; use another device",
                             impl.name, local_size, context.info.name));
  }
  if (status != CL_SUCCESS) {
    context.check(status, "clEnqueueNDRangeKernel",
                  fmt::format("kernel '{}', {} work-items in groups of {}", impl.name, global_size,
                              local_size));
  }
  impl.launched = true;
  if (compiling.owns_lock()) context_.finish();
  if (!context.profile) return;
  EventHandle owned(event);
  if (time_preparation) {
    context_.finish();
    context.times.add_first(impl.name, std::move(owned), stopwatch.seconds());
  } else {
    context.times.add(impl.name, std::move(owned));
  }
}

/// Events kept before they are summed: bounds the memory of a long run.
constexpr std::size_t max_pending = 4096;

void KernelTimes::add_preparation(const std::string& kernel, double seconds) {
  auto& total = totals_[kernel];
  total.kernel = kernel;
  total.preparation_seconds += seconds;
}

void KernelTimes::add_first(const std::string& kernel, EventHandle event, double seconds) {
  collect();
  const double before = totals_[kernel].seconds;
  add(kernel, std::move(event));
  collect();
  add_preparation(kernel, seconds - (totals_[kernel].seconds - before));
}

void KernelTimes::add(const std::string& kernel, EventHandle event) {
  pending_.emplace_back(kernel, std::move(event));
  if (pending_.size() >= max_pending) collect();
}

void KernelTimes::collect() {
  for (const auto& [kernel, event] : pending_) {
    const cl_event raw = event.get();
    check(clWaitForEvents(1, &raw), "clWaitForEvents", "kernel " + kernel);
    cl_ulong start = 0, end = 0;
    check(clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr),
          "clGetEventProfilingInfo");
    check(clGetEventProfilingInfo(raw, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr),
          "clGetEventProfilingInfo");
    auto& total = totals_[kernel];
    total.kernel = kernel;
    ++total.launches;
    total.seconds += static_cast<double>(end - start) * 1e-9;
  }
  pending_.clear();
}

std::vector<KernelTime> KernelTimes::total() {
  collect();
  std::vector<KernelTime> times;
  for (const auto& [kernel, time] : totals_) {
    if (time.launches > 0) times.push_back(time);
  }
  return times;
}

}  // namespace photile::device
