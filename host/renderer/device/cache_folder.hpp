// Where photile may keep files between runs and during a run; warnings about trouble there, which
// never stops a run; and the results of device tests, which are kept there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "photile/device.hpp"

namespace photile::device {

/// Free space below which a folder is not used: PoCL ends the process when its disk is full.
inline constexpr std::uint64_t min_free_cache_bytes = 64ull << 20;

/// photile's own cache folder, created if need be: $XDG_CACHE_HOME/photile, else
/// $HOME/.cache/photile. None where neither can be written or has room.
std::optional<std::filesystem::path> persistent_cache_folder();

/// The folders of kernels that were compiled when photile was installed, which are only read:
/// photile/kernels below each of $XDG_DATA_DIRS, else below /usr/local/share and /usr/share.
std::vector<std::filesystem::path> installed_kernel_folders();

/// "" where compiled code can be kept in and loaded from `folder`, which is created if need be;
/// else what is wrong.
std::string folder_problem(const std::filesystem::path& folder);

/// Writes "photile: warning: <line>" to the standard error stream.
void warn(const std::string& line);

/// The value of DeviceInfo::test_result for a device that has passed.
inline constexpr const char* passed = "passed";

/// The result of the last test of this device with this driver and these kernels; "" where none is
/// kept.
std::string kept_test_result(const DeviceInfo& device);

/// Keeps a result. Where no folder can be written, it only warns.
void keep_test_result(const DeviceInfo& device, const std::string& result);

}  // namespace photile::device
