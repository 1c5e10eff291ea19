#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <mutex>

#include "common/process_limits.hpp"
#include "device/cache_folder.hpp"
#include "device/context_impl.hpp"
#include "device/device_list.hpp"
#include "device/device_selection.hpp"

namespace photile::device {
namespace {

/// The devices that the selector means, sub-devices made.
std::vector<ListedDevice> find_all(const std::string& selector) {
  DeviceList list = enumerate_devices();
  std::vector<DeviceInfo> infos;
  for (const auto& listed : list.usable) infos.push_back(listed.info);
  const std::vector<DeviceChoice> choices = select_devices(infos, selector, list.left_out);
  if (chooses_best(selector)) {
    static std::once_flag told;
    const std::string line = untested_gpu(infos, infos[choices.front().index]);
    if (!line.empty()) std::call_once(told, [&] { warn(line); });
  }
  std::vector<ListedDevice> chosen;
  for (const DeviceChoice& choice : choices) {
    ListedDevice& listed = list.usable[choice.index];
    if (choice.compute_units.empty()) {
      chosen.push_back(std::move(listed));
    } else {
      for (auto& part : make_sub_devices(listed, choice.compute_units)) {
        chosen.push_back(std::move(part));
      }
    }
  }
  return chosen;
}

ListedDevice find_one(const std::string& selector) {
  std::vector<ListedDevice> found = find_all(selector);
  if (found.size() != 1) {
    std::vector<std::string> ids;
    for (const auto& listed : found) ids.push_back(listed.info.id);
    throw DeviceError(fmt::format(
        "{} devices are selected ({}), but one is needed; select one by its number or by {}",
        found.size(), fmt::join(ids, ", "), device_variable));
  }
  return std::move(found.front());
}

/// A card draws the display and serves other programs: a tenth of its memory is left to them. The
/// buffers of a CPU are the process's own, and PoCL ends it where it may have no more.
std::uint64_t usable_memory(const DeviceInfo& info) {
  const std::uint64_t bytes = info.global_memory_bytes;
  if (info.type != DeviceType::cpu) return bytes - bytes / 10;
  const std::uint64_t left = address_bytes_left();
  constexpr std::uint64_t others = reserved_address_bytes / 2;  // the compiler is loaded by now
  return std::min(bytes, left - std::min(left, others));
}

}  // namespace

Context::Impl::Impl(ListedDevice listed, const DeviceOptions& options)
    : info(std::move(listed.info)),
      sub_device(std::move(listed.sub_device)),
      device(listed.device),
      memory_limit(usable_memory(info)),
      profile(options.profile) {
  limited = options.memory_bytes != 0 && options.memory_bytes < memory_limit;
  if (limited) memory_limit = options.memory_bytes;
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
  throw DeviceMemoryError(
      fmt::format("{}; {}; '{}' allows {} bytes per buffer and {} {} bytes of memory, of which {} "
                  "are in use; use {}",
                  failure_text(call, status), what, info.name, info.max_allocation_bytes,
                  limited ? "may use" : "has", memory_limit, memory->live.load(),
                  limited ? "a larger memory limit, fewer photons or a smaller radius"
                          : "fewer photons or a smaller radius"),
      status);
}

bool Context::Impl::reclaim() {
  if (reclaiming) return false;
  reclaiming = true;
  const auto released = [](Reclaimer* reclaimer) { return reclaimer->reclaim(); };
  const bool any = std::any_of(reclaimers->rbegin(), reclaimers->rend(), released);
  reclaiming = false;
  return any;
}

Reclaimer::Reclaimer(Context& context) : all_(context.impl_->reclaimers) { all_->push_back(this); }

Reclaimer::~Reclaimer() { std::erase(*all_, this); }

Context::Context(const DeviceOptions& options) : Context(find_one(options.selector), options) {}

Context::Context(ListedDevice&& listed, const DeviceOptions& options)
    : impl_(std::make_unique<Impl>(std::move(listed), options)) {}

std::vector<std::unique_ptr<Context>> Context::open_all(const DeviceOptions& options) {
  std::vector<std::unique_ptr<Context>> contexts;
  for (ListedDevice& listed : find_all(options.selector)) {
    contexts.emplace_back(new Context(std::move(listed), options));
  }
  return contexts;
}

Context::~Context() {
  // Kernels that still run use the programs and PoCL's files. An error has been reported by then,
  // or the result is not needed.
  clFinish(impl_->queue.get());
}

const DeviceInfo& Context::info() const { return impl_->info; }
std::uint64_t Context::memory_limit() const { return impl_->memory_limit; }
std::uint64_t Context::largest_buffer() const {
  return std::min(impl_->info.max_allocation_bytes, impl_->memory_limit);
}

void Context::finish() { impl_->check(clFinish(impl_->queue.get()), "clFinish", impl_->info.name); }

double Context::compile_seconds() const { return impl_->programs->compile_seconds(); }
std::uint64_t Context::programs_built() const { return impl_->programs->built(); }
std::uint64_t Context::programs_from_cache() const { return impl_->programs->from_cache(); }
std::uint64_t Context::allocated_bytes() const { return impl_->memory->live; }
std::uint64_t Context::peak_allocated_bytes() const { return impl_->memory->peak; }
const std::vector<ProgramTime>& Context::program_times() const { return impl_->programs->times(); }
std::vector<KernelTime> Context::kernel_times() const { return impl_->times.total(); }

double Context::transfer_seconds() const {
  double seconds = 0;
  for (const KernelTime& time : impl_->transfers.total()) seconds += time.seconds;
  return seconds;
}

}  // namespace photile::device
