#include "device/pocl_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <utility>

#include "device/cache_folder.hpp"

namespace photile::device {

namespace fs = std::filesystem;

PoclCache::PoclCache(fs::path work, KernelStore store)
    : work_(std::move(work)), store_(std::move(store)) {}

PoclCache::Program PoclCache::restored(const CacheKey& key) const {
  const std::optional<std::string> packed = store_.load(key);
  if (!packed) return {key, {}, 0};
  try {
    const auto files = unpack(*packed);
    restore_files(work_, files);
    return {key, program_folders(files), files.size()};
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels '{}' cannot be restored: {}", store_.file(key).string(),
                     error.what()));
    return {key, {}, 0};
  }
}

bool PoclCache::build(const CacheKey& key, const std::function<void()>& build) {
  const std::lock_guard lock(mutex_);
  auto entry = programs_.find(key.hex());
  if (entry == programs_.end()) entry = programs_.emplace(key.hex(), restored(key)).first;

  const auto before = program_folders(work_);
  build();
  const auto after = program_folders(work_);
  std::set<std::string> added;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::inserter(added, added.end()));
  if (added.empty()) return true;
  entry->second.folders = added;
  entry->second.stored_files = 0;
  return false;
}

void PoclCache::publish() noexcept {
  try {
    const std::lock_guard lock(mutex_);
    for (auto& [name, program] : programs_) {
      const auto files = collect_files(work_, program.folders);
      if (files.size() == program.stored_files) continue;
      if (!store_.store(program.key, pack(files))) return;
      program.stored_files = files.size();
    }
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels are not kept: {}", error.what()));
  }
}

}  // namespace photile::device
