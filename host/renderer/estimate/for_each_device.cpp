#include "estimate/for_each_device.hpp"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "photile/errors.hpp"

namespace photile::estimate {
namespace {

/// What one of several devices sees of the progress: only the first tells, all are stopped.
class SharedProgress : public Progress {
 public:
  SharedProgress(Progress& progress, bool tells, const std::atomic<bool>& failed)
      : progress_(progress), tells_(tells), failed_(failed) {}

  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override {
    if (tells_) progress_.begin(stage, total, unit);
  }
  void advance(std::uint64_t count) override {
    if (tells_) progress_.advance(count);
  }
  void end() override {
    if (tells_) progress_.end();
  }
  void note(const std::string& line) override {
    if (tells_) progress_.note(line);
  }
  bool cancelled() const override { return failed_ || progress_.cancelled(); }

 private:
  Progress& progress_;
  bool tells_;
  const std::atomic<bool>& failed_;
};

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
        SharedProgress shared(progress, i == 0, failed);
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

}  // namespace photile::estimate
