#include "photile/device.hpp"

#include "device/context.hpp"

namespace photile {

Device::Device(const DeviceOptions& options)
    : context_(std::make_unique<device::Context>(options)) {}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const { return context_->info(); }
double Device::compile_seconds() const { return context_->compile_seconds(); }
std::uint64_t Device::programs_built() const { return context_->programs_built(); }
std::uint64_t Device::programs_from_cache() const { return context_->programs_from_cache(); }

}  // namespace photile
