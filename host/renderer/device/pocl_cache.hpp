// PoCL's compiled kernels: the folder in which PoCL keeps them while this process runs, and what
// photile keeps of them between runs.
//
// PoCL (3.1) ends the process on a truncated shared object, a damaged program.bc or a folder that
// it cannot write, and two processes may be writing one folder at a time, so that no check of a
// shared folder holds. Every process therefore gets its own new folder, into which only verified
// files are put (PoclCache), and which is removed when the process ends. A killed process's folder
// is removed when the next one starts.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "device/kernel_store.hpp"

namespace photile::device {

/// The folder, which the first call creates and passes to PoCL in POCL_CACHE_DIR; to be called
/// before the first OpenCL call. Empty where the user set POCL_CACHE_DIR to a folder that can be
/// written, which is left alone. Errors: DeviceError when no folder can be written at all.
const std::filesystem::path& pocl_work_folder();

// PoCL's compiled kernels, kept between runs as one checked file per program.
//
// Asking PoCL for a program's binary makes it compile an extra version, so photile keeps PoCL's own
// files instead: before a build, the verified files of that program are put into the work folder;
// when a context closes, what PoCL added is packed and published under photile's cache folder. A
// process that dies publishes nothing.

/// One per work folder, shared by the contexts of a process. Thread-safe.
class PoclCache {
 public:
  /// `work` is PoCL's folder, `store` where the packs live.
  PoclCache(std::filesystem::path work, KernelStore store);

  /// Restores the program's files if they are stored and sound, then calls `build`, which builds
  /// it. Returns true where PoCL found the program compiled. A damaged pack is a warning.
  bool build(const CacheKey& key, const std::function<void()>& build);

  /// Stores every program that has files which its pack lacks. A failure is a warning.
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
  std::map<CacheKey, Program> programs_;
  std::mutex mutex_;
};

}  // namespace photile::device
