#include "device/cache_key.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace photile::device {
namespace {

/// Variables of PoCL that do not change the code: where its cache is, what it prints, how many
/// threads it starts (`photile render --threads` sets the last two).
constexpr std::array<std::string_view, 4> without_effect{
    "POCL_CACHE_DIR=", "POCL_DEBUG", "POCL_MAX_PTHREAD_COUNT=", "POCL_CPU_MAX_CU_COUNT="};

/// The entries of the environment that begin like this, sorted, but for those without effect.
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
  // Variables of PoCL, or of Intel's runtime, which others ignore.
  for (const auto& variable : variables_of(device.is_pocl ? "POCL_" : "CL_CONFIG_")) add(variable);
  return hash(text);
}

}  // namespace photile::device
