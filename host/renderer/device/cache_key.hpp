// The identity of a compiled program: 128 bits over everything that may change its code.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "photile/device.hpp"

namespace photile::device {

struct CacheKey {
  std::array<unsigned char, 16> bytes{};
  std::string hex() const;  ///< 32 digits
  friend bool operator==(const CacheKey&, const CacheKey&) = default;
};

/// XXH3-128 of `text`, in the canonical (big-endian) form.
CacheKey hash(std::string_view text);

/// Key of the program `source` built with `options` on `device`: platform name and version, device
/// name, vendor, device and driver versions, options and source; on PoCL also the POCL_* variables,
/// several of which change the code that it generates.
CacheKey program_key(const DeviceInfo& device, std::string_view options, std::string_view source);

}  // namespace photile::device
