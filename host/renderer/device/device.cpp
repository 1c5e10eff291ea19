#include "photile/device.hpp"

#include "device/context.hpp"

namespace photile {

Device::Device(const DeviceOptions& options)
    : context_(std::make_unique<device::Context>(options)) {}
Device::Device(std::unique_ptr<device::Context> context) : context_(std::move(context)) {}

device::Context& device::context_of(Device& device) { return *device.context_; }
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const { return context_->info(); }
double Device::compile_seconds() const { return context_->compile_seconds(); }
std::uint64_t Device::programs_built() const { return context_->programs_built(); }
std::uint64_t Device::programs_from_cache() const { return context_->programs_from_cache(); }
std::uint64_t Device::peak_allocated_bytes() const { return context_->peak_allocated_bytes(); }

std::vector<Device> open_devices(const DeviceOptions& options) {
  std::vector<Device> devices;
  for (auto& context : device::Context::open_all(options)) {
    devices.push_back(Device(std::move(context)));
  }
  return devices;
}

}  // namespace photile
