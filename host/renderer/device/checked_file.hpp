// A file that is either whole and of the expected key, or not used at all.
//
//   offset  bytes  content
//        0      8  magic "PHOTILEC"
//        8      4  format version, host byte order
//       12      4  zero
//       16     16  key
//       32      8  length of the payload
//       40     16  XXH3-128 of bytes 0..39 and the payload
//       56      -  payload
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "device/cache_key.hpp"

namespace photile::device {

inline constexpr std::size_t checked_file_header_bytes = 56;

struct CheckedRead {
  std::optional<std::string> payload;  ///< set only when every check passed
  std::string problem;                 ///< why not; empty where there is no such file
};

/// Reads and verifies. Never throws on account of the file.
CheckedRead read_checked_file(const std::filesystem::path& file, const CacheKey& key);

/// Writes to a temporary name in the same folder, syncs, renames: a reader sees the old file or the
/// whole new one. Returns "" or what went wrong; the temporary file is gone then.
std::string write_checked_file(const std::filesystem::path& file, const CacheKey& key,
                               std::string_view payload);

}  // namespace photile::device
