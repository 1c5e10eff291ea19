#include "device/kernel_times.hpp"

namespace photile::device {

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
