#include "estimate/load_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <vector>

#include "common/stoppable_progress.hpp"
#include "photile/errors.hpp"

namespace photile::estimate {

namespace {

/// Runs `work` and names the device in its error.
void run_named(const DeviceInfo& device, const std::function<void()>& work) {
  const auto named = [&](const DeviceError& error) {
    return fmt::format("{} {}: {}", device.id, device.name, error.what());
  };
  try {
    work();
  } catch (const KernelBuildError&) {
    throw;  // names its device, and carries the build log
  } catch (const DeviceMemoryError& error) {
    throw DeviceMemoryError(named(error), error.status);
  } catch (const DeviceError& error) {
    throw DeviceError(named(error), error.status);
  }
}

[[noreturn]] void rethrow_cause(std::span<const std::exception_ptr> errors) {
  std::exception_ptr interruption;
  for (const std::exception_ptr& error : errors) {
    if (!error) continue;
    try {
      std::rethrow_exception(error);
    } catch (const Interrupted&) {
      interruption = error;  // by the user, or since another device failed
    }
  }
  std::rethrow_exception(interruption);
}

}  // namespace

void for_each_device(std::span<Device> devices, Progress& progress,
                     const std::function<void(std::size_t, Progress&)>& work) {
  if (devices.size() == 1) return work(0, progress);
  std::atomic<bool> failed = false;
  std::vector<std::exception_ptr> errors(devices.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      threads.emplace_back([&, i] {
        // Only the first reports, all are stopped.
        StoppableProgress shared(i == 0 ? progress : Progress::none(),
                                 [&] { return failed || progress.cancelled(); });
        try {
          run_named(devices[i].info(), [&] { work(i, shared); });
        } catch (...) {
          errors[i] = std::current_exception();
          failed = true;
        }
      });
    }
  }
  if (failed) rethrow_cause(errors);
}

namespace {

/// Hits of the first rounds, for each device: launches that cost more than what they launch, but
/// little beside a picture; then enough to tell devices apart.
constexpr std::size_t warm_up_hits = 1024;
constexpr std::size_t probe_hits = 16'384;

}  // namespace

LoadBalance::LoadBalance(std::size_t devices) : work_(devices) {}

std::size_t LoadBalance::round(std::size_t left) const {
  if (work_.size() == 1 || rounds_ >= 2) return left;
  return std::min(left, work_.size() * (rounds_ == 0 ? warm_up_hits : probe_hits));
}

double LoadBalance::throughput(const Work& work) const {
  return work.seconds > 0 ? static_cast<double>(work.measured_hits) / work.seconds : 0;
}

std::vector<std::size_t> LoadBalance::cuts(std::size_t count) const {
  std::vector<double> weights;
  double sum = 0;
  for (const Work& work : work_) sum += weights.emplace_back(throughput(work));
  // Until every device has been measured, and where a clock does not advance, all count the same.
  const bool even = !std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
  std::vector<std::size_t> cuts{0};
  double below = 0;
  for (std::size_t i = 0; i + 1 < work_.size(); ++i) {
    below += even ? 1.0 / static_cast<double>(work_.size()) : weights[i] / sum;
    const auto cut = static_cast<std::size_t>(std::llround(below * static_cast<double>(count)));
    cuts.push_back(std::clamp(cut, cuts.back(), count));
  }
  cuts.push_back(count);
  return cuts;
}

void LoadBalance::record(std::size_t device, std::size_t hits, double seconds) {
  Work& work = work_[device];
  work.hits += hits;
  if (rounds_ == 0 && work_.size() > 1) return;
  work.measured_hits += hits;
  work.seconds += seconds;
}

std::vector<double> LoadBalance::fractions() const {
  std::size_t all = 0;
  for (const Work& work : work_) all += work.hits;
  std::vector<double> fractions;
  for (const Work& work : work_) {
    fractions.push_back(all == 0 ? 0 : static_cast<double>(work.hits) / static_cast<double>(all));
  }
  return fractions;
}

}  // namespace photile::estimate
