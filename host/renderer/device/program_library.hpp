// The programs of one context: built once each, from the caches on disk where they hold them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/context.hpp"
#include "device/kernel_store.hpp"
#include "device/pocl_cache.hpp"
#include "device/program.hpp"

namespace photile::device {

struct Program {
  ProgramHandle handle;
  ArgumentNames arguments;  ///< of programs from a binary, whose kernels need not tell them
};

class ProgramLibrary {
 public:
  ProgramLibrary(const BuildTarget& target, bool use_cache);
  /// Publishes what PoCL compiled.
  ~ProgramLibrary();
  ProgramLibrary(const ProgramLibrary&) = delete;
  ProgramLibrary& operator=(const ProgramLibrary&) = delete;

  /// The program of kernel file `file` built with `defines` ("-D NAME=VALUE ..."). Lives as long as
  /// the library. Errors: KernelBuildError.
  const Program& get(const std::string& file, const std::string& defines);

  const std::vector<ProgramTime>& times() const { return times_; }
  double compile_seconds() const;
  std::uint64_t built() const { return built_; }
  std::uint64_t from_cache() const { return from_cache_; }

 private:
  std::string options(const std::string& defines) const;
  Program load_or_build(const std::string& file, const std::string& options);
  /// From the cache of runtimes other than PoCL; an empty handle where it has no usable program.
  Program load(const CacheKey& key, const std::string& options);

  BuildTarget target_;
  std::string base_options_;
  PoclCache* pocl_cache_ = nullptr;   ///< on PoCL, unless switched off
  std::optional<KernelStore> cache_;  ///< on others, unless switched off
  std::map<std::pair<std::string, std::string>, Program> programs_;  ///< by file, defines
  std::vector<ProgramTime> times_;
  std::uint64_t built_ = 0, from_cache_ = 0;
};

}  // namespace photile::device
