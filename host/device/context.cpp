#include <fmt/format.h>

#include "device/context_impl.hpp"
#include "device/device_selection.hpp"
#include "device/status_names.hpp"

namespace photile::device {
namespace {

ListedDevice open(const std::string& selector) {
  const auto list = enumerate_devices();
  std::vector<DeviceInfo> infos;
  for (const auto& listed : list.usable) infos.push_back(listed.info);
  return list.usable[select_device(infos, selector, list.left_out)];
}

}  // namespace

Context::Impl::Impl(const DeviceOptions& options) : profile(options.profile) {
  const auto listed = open(options.selector);
  info = listed.info;
  const cl_context_properties properties[] = {
      CL_CONTEXT_PLATFORM, reinterpret_cast<cl_context_properties>(listed.platform), 0};
  cl_int status = CL_SUCCESS;
  context =
      ContextHandle(clCreateContext(properties, 1, &listed.device, nullptr, nullptr, &status));
  check(status, "clCreateContext", info.name);
  queue = QueueHandle(clCreateCommandQueue(context.get(), listed.device,
                                           profile ? CL_QUEUE_PROFILING_ENABLE : 0, &status));
  check(status, "clCreateCommandQueue", info.name);
  programs = std::make_unique<ProgramLibrary>(BuildTarget{context.get(), listed.device, &info},
                                              options.use_program_cache);
}

void Context::Impl::check(cl_int status, std::string_view call, const std::string& what) const {
  if (status == CL_SUCCESS) return;
  if (!is_out_of_memory(status)) throw_status(status, call, what);
  throw_status(status, call,
               fmt::format("{}; '{}' allows {} bytes a buffer and has {} bytes of memory, {} bytes "
                           "are in use; use fewer photons or a smaller radius",
                           what, info.name, info.max_allocation_bytes, info.global_memory_bytes,
                           memory->live.load()));
}

Context::Context(const DeviceOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Context::~Context() {
  // Kernels that still run use the programs and PoCL's files. An error has been reported by then,
  // or nobody waits for the result.
  clFinish(impl_->queue.get());
}

const DeviceInfo& Context::info() const { return impl_->info; }

void Context::finish() { impl_->check(clFinish(impl_->queue.get()), "clFinish", impl_->info.name); }

double Context::compile_seconds() const { return impl_->programs->compile_seconds(); }
std::uint64_t Context::programs_built() const { return impl_->programs->built(); }
std::uint64_t Context::programs_from_cache() const { return impl_->programs->from_cache(); }
std::uint64_t Context::allocated_bytes() const { return impl_->memory->live; }
std::uint64_t Context::peak_allocated_bytes() const { return impl_->memory->peak; }
std::vector<KernelTime> Context::kernel_times() const { return impl_->times.total(); }

}  // namespace photile::device
