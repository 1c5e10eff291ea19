// Compiled kernels on disk, one checked file per program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/cache_key.hpp"

namespace photile::device {

class KernelStore {
 public:
  /// Keeps its files in `folder`, created if need be, and reads those of `installed` too.
  ///   ending   of the names of its files, with the point
  KernelStore(std::filesystem::path folder, std::vector<std::filesystem::path> installed,
              std::string ending);

  /// What was stored under `key`, verified. None where no folder has such a file (silently) or none
  /// is as it was written (a warning for each).
  std::optional<std::string> load(const CacheKey& key) const;

  /// Stores `kernels` in the folder. What goes wrong is a warning, and false.
  bool store(const CacheKey& key, std::string_view kernels) const;

  /// The file of a key in the folder.
  std::filesystem::path file(const CacheKey& key) const { return folder_ / name(key); }

 private:
  std::string name(const CacheKey& key) const { return key.hex() + ending_; }

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> installed_;
  std::string ending_;
};

}  // namespace photile::device
