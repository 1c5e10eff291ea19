// PoCL's compiled kernels, kept between runs as one checked file per program.
//
// Asking PoCL for a program's binary makes it compile an extra version, so photile keeps PoCL's own
// files instead: before a build, the verified files of that program are put into the work folder;
// when a context closes, what PoCL added is packed and published under photile's cache folder. A
// process that dies publishes nothing.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "device/cache_key.hpp"
#include "device/kernel_store.hpp"

namespace photile::device {

/// One per work folder, shared by the contexts of a process. Thread-safe.
class PoclCache {
 public:
  /// `work` is PoCL's folder, `store` where the packs live.
  PoclCache(std::filesystem::path work, KernelStore store);

  /// Restores the program's files if they are stored and sound, then calls `build`, which builds
  /// it. Returns true where PoCL found the program compiled. A damaged pack is a warning.
  bool build(const CacheKey& key, const std::function<void()>& build);

  /// Stores every program that has files which its pack lacks. What goes wrong is a warning.
  void publish() noexcept;

 private:
  struct Program {
    CacheKey key;
    std::filesystem::path folder{};  ///< PoCL's, below the work folder; empty before it is known
    std::size_t stored_files = 0;    ///< in its pack
  };

  void restore(Program& program) const;

  std::filesystem::path work_;
  KernelStore store_;
  std::map<std::string, Program> programs_;  ///< by hexadecimal key
  std::mutex mutex_;
};

}  // namespace photile::device
