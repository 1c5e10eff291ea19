// What photile_device_probe prints when it runs its kernel.
#pragma once

#include <string>

namespace photile::test {

/// 999^2, and the sum of i^2 for i < 1000.
inline const std::string right = "last=998001 sum=332833500";
inline const std::string compiled = right + " built=1 cached=0\n";
inline const std::string restored = right + " built=0 cached=1\n";

}  // namespace photile::test
