#include "device/kernel_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "common/files.hpp"
#include "device/cache_folder.hpp"
#include "photile/errors.hpp"

namespace photile::device {

namespace {

/// Variables of PoCL that do not change the code: where its cache is, what it prints, how many
/// threads it starts (`photile render --threads` sets the last two).
constexpr std::array<std::string_view, 4> without_effect{
    "POCL_CACHE_DIR=", "POCL_DEBUG", "POCL_MAX_PTHREAD_COUNT=", "POCL_CPU_MAX_CU_COUNT="};

/// The entries of the environment that begin like this, sorted, except those without effect.
std::set<std::string> variables_of(std::string_view runtime) {
  std::set<std::string> entries;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (text.starts_with(runtime) &&
        std::none_of(without_effect.begin(), without_effect.end(),
                     [&](std::string_view variable) { return text.starts_with(variable); })) {
      entries.emplace(text);
    }
  }
  return entries;
}

}  // namespace

CacheKey program_key(const DeviceInfo& device, std::string_view options, std::string_view source) {
  ContentHash hash;
  const auto add = [&](std::string_view field) { hash.add(std::string(field)); };
  add("format 2");  // of what is kept
  add(device.platform);
  add(device.platform_version);
  add(device.name);
  add(device.vendor);
  add(device.version);
  add(device.driver_version);
  add(options);
  add(source);
  // Variables of PoCL, or of Intel's runtime, which others ignore.
  for (const auto& variable : variables_of(device.is_pocl ? "POCL_" : "CL_CONFIG_")) add(variable);
  return hash.digest();
}

namespace {

std::string checksum_of(const CacheKey& key, std::string_view payload) {
  ContentHash hash;
  hash.add_bytes(key.data(), key.size());
  hash.add_bytes(payload.data(), payload.size());
  const auto digest = hash.digest();
  return {digest.begin(), digest.end()};
}

}  // namespace

namespace fs = std::filesystem;

CheckedRead read_checked_file(const fs::path& path, const CacheKey& key) {
  std::error_code error;
  if (!fs::exists(path, error) && !error) return {};
  try {
    const std::string bytes = read_own_text(path);
    std::string payload = bytes.substr(std::min(bytes.size(), CacheKey{}.size()));
    if (bytes != checksum_of(key, payload) + payload) return {{}, "damaged"};
    return {std::move(payload), {}};
  } catch (const InputError& problem) {
    return {{}, problem.what()};
  }
}

void write_checked_file(const fs::path& path, const CacheKey& key, std::string_view payload) {
  write_file(path, checksum_of(key, payload).append(payload));
}

KernelStore::KernelStore(fs::path folder, std::vector<fs::path> installed, std::string ending)
    : folder_(std::move(folder)), installed_(std::move(installed)), ending_(std::move(ending)) {
  std::error_code ignored;  // storing will say so
  fs::create_directories(folder_, ignored);
}

std::optional<std::string> KernelStore::load(const CacheKey& key) const {
  std::vector<fs::path> folders{folder_};
  folders.insert(folders.end(), installed_.begin(), installed_.end());
  for (const fs::path& folder : folders) {
    const fs::path file = folder / name(key);
    CheckedRead read = read_checked_file(file, key);
    if (read.payload) return std::move(read.payload);
    if (!read.problem.empty()) {
      warn(fmt::format("compiled kernels '{}': {}; not used", file.string(), read.problem));
    }
  }
  return std::nullopt;
}

bool KernelStore::store(const CacheKey& key, std::string_view kernels) const {
  try {
    write_checked_file(file(key), key, kernels);
    return true;
  } catch (const OutputError& error) {
    warn(fmt::format("compiled kernels are not kept: {}", error.what()));
    return false;
  }
}

}  // namespace photile::device
