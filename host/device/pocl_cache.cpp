#include "device/pocl_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>

#include "device/cache_folder.hpp"
#include "device/checked_file.hpp"

namespace photile::device {

namespace fs = std::filesystem;

PoclCache::PoclCache(fs::path work, fs::path store)
    : work_(std::move(work)), store_(std::move(store)) {
  std::error_code ignored;  // publishing will say so
  fs::create_directories(store_, ignored);
}

fs::path PoclCache::pack_file(const CacheKey& key) const { return store_ / (key.hex() + ".pack"); }

PoclCache::Program PoclCache::restored(const CacheKey& key) const {
  const auto file = pack_file(key);
  const auto read = read_checked_file(file, key);
  if (!read.payload) {
    if (!read.problem.empty()) {
      warn(fmt::format("compiled kernels '{}': {}; compiling again", file.string(), read.problem));
    }
    return {key, {}, 0};
  }
  try {
    const auto files = unpack(*read.payload);
    restore_files(work_, files);
    return {key, program_folders(files), files.size()};
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels '{}' cannot be restored: {}", file.string(), error.what()));
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
      const auto problem = write_checked_file(pack_file(program.key), program.key, pack(files));
      if (!problem.empty()) throw std::runtime_error(problem);
      program.stored_files = files.size();
    }
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels are not kept in '{}': {}", store_.string(), error.what()));
  }
}

}  // namespace photile::device
