#include "device/cache_key.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <set>

namespace photile::device {
namespace {

/// The "POCL_NAME=value" entries of the environment, sorted. Its cache folder and what it prints do
/// not change the code.
std::set<std::string> pocl_variables() {
  std::set<std::string> entries;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (text.starts_with("POCL_") && !text.starts_with("POCL_CACHE_DIR=") &&
        !text.starts_with("POCL_DEBUG")) {
      entries.emplace(text);
    }
  }
  return entries;
}

}  // namespace

std::string CacheKey::hex() const {
  std::string digits;
  for (const unsigned char byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

CacheKey hash(std::string_view text) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(text.data(), text.size()));
  CacheKey key;
  static_assert(sizeof canonical.digest == sizeof key.bytes);
  std::copy(std::begin(canonical.digest), std::end(canonical.digest), key.bytes.begin());
  return key;
}

CacheKey program_key(const DeviceInfo& device, std::string_view options, std::string_view source) {
  // The length before each field keeps ("ab", "c") and ("a", "bc") apart.
  std::string text;
  const auto add = [&](std::string_view field) {
    text += fmt::format("{}:", field.size());
    text += field;
  };
  add(device.platform);
  add(device.platform_version);
  add(device.name);
  add(device.vendor);
  add(device.version);
  add(device.driver_version);
  add(options);
  add(source);
  if (device.is_pocl) {
    for (const auto& variable : pocl_variables()) add(variable);
  }
  return hash(text);
}

}  // namespace photile::device
