// Program binaries on disk, one checked file per program. For every runtime but PoCL, which has a
// cache of its own (pocl_cache.hpp).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "device/cache_key.hpp"

namespace photile::device {

class ProgramCache {
 public:
  /// Keeps its files in `folder`, created if need be.
  explicit ProgramCache(std::filesystem::path folder);

  /// The binary stored under `key`, verified. None where there is no file (silently) or the file is
  /// not as it was written (a warning).
  std::optional<std::string> load(const CacheKey& key) const;

  /// Stores a binary; what goes wrong is a warning.
  void store(const CacheKey& key, const std::string& binary) const;

  /// The file of a key.
  std::filesystem::path file(const CacheKey& key) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace photile::device
