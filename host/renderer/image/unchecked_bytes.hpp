// From which size on a picture is held against the bytes that it is decoded from.
#pragma once

#include <cstdint>

#include "photile/limits.hpp"

namespace photile::image {

/// Decoded bytes that are not worth a check. Fuzzers take fewer: an input is to take microseconds.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
inline constexpr std::uint64_t unchecked_bytes = 1ull << 20;
#else
inline constexpr std::uint64_t unchecked_bytes = limits::unchecked_image_bytes;
#endif

}  // namespace photile::image
