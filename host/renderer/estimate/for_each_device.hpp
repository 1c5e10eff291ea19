// Work on several devices at once.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "photile/device.hpp"
#include "photile/progress.hpp"

namespace photile::estimate {

/// Calls work(i, progress) for every device i, each on a thread of its own, and returns once all
/// have ended. The first device tells `progress` of its stages, all of them hear of a wish to stop.
/// Where one fails, the others are asked to stop, and the error is thrown once they have: that of
/// the first of the devices that failed by themselves, a DeviceError with its device's name.
void for_each_device(std::span<Device> devices, Progress& progress,
                     const std::function<void(std::size_t, Progress&)>& work);

}  // namespace photile::estimate
