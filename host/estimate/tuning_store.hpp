// Tunings between runs: a JSON file per device.
#pragma once

#include <filesystem>
#include <optional>

#include "photile/device.hpp"
#include "photile/estimate_tuning.hpp"

namespace photile::estimate {

/// The file in `folder` that keeps the tunings of a device with its driver.
std::filesystem::path tuning_file(const std::filesystem::path& folder, const DeviceInfo& device);

/// Sets the tuning for scenes like `needs`; others that the file holds stay, unless they belong to
/// other kernels. Written under a temporary name, then renamed. Errors: OutputError.
void write_tuning(const std::filesystem::path& file, const SceneNeeds& needs,
                  const EstimateTuning& tuning);

/// None where the file is missing, damaged, or belongs to other kernels.
std::optional<EstimateTuning> read_tuning(const std::filesystem::path& file,
                                          const SceneNeeds& needs);

}  // namespace photile::estimate
