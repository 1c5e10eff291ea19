// Compiled kernels on disk: their identity, 128 bits over everything that may change their code,
// and one checked file per program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/content_hash.hpp"
#include "photile/device.hpp"

namespace photile::device {

using CacheKey = ContentHash::Digest;

/// Key of the program `source` built with `options` on `device`: platform name and version, device
/// name, vendor, device and driver versions, options and source; on PoCL also the POCL_* variables,
/// several of which change the code that it generates.
CacheKey program_key(const DeviceInfo& device, std::string_view options, std::string_view source);

// A file that is either whole and of the expected key, or not used at all: the XXH3-128 of the key
// and the payload, and the payload.

struct CheckedRead {
  std::optional<std::string> payload;  ///< set only when every check passed
  std::string problem;                 ///< why it is not set; empty where there is no such file
};

/// Reads and verifies. Never throws because of the file.
CheckedRead read_checked_file(const std::filesystem::path& file, const CacheKey& key);

/// A reader sees the old file or the whole new one. Errors: OutputError.
void write_checked_file(const std::filesystem::path& file, const CacheKey& key,
                        std::string_view payload);

class KernelStore {
 public:
  /// Keeps its files in `folder`, created if need be, and reads those of `installed` too.
  ///   ending   of the names of its files, with the point
  KernelStore(std::filesystem::path folder, std::vector<std::filesystem::path> installed,
              std::string ending);

  /// What was stored under `key`, verified. None where no folder has such a file (silently), or
  /// where all such files are damaged (with a warning for each).
  std::optional<std::string> load(const CacheKey& key) const;

  /// Stores `kernels` in the folder. A failure is a warning, and returns false.
  bool store(const CacheKey& key, std::string_view kernels) const;

  /// The file of a key in the folder.
  std::filesystem::path file(const CacheKey& key) const { return folder_ / name(key); }

 private:
  std::string name(const CacheKey& key) const { return hex(key) + ending_; }

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> installed_;
  std::string ending_;
};

}  // namespace photile::device
