#include "device/kernel_store.hpp"

#include <fmt/format.h>

#include "device/cache_folder.hpp"
#include "device/checked_file.hpp"

namespace photile::device {

namespace fs = std::filesystem;

KernelStore::KernelStore(fs::path folder, std::vector<fs::path> installed, std::string ending)
    : folder_(std::move(folder)), installed_(std::move(installed)), ending_(std::move(ending)) {
  std::error_code ignored;  // storing will say so
  fs::create_directories(folder_, ignored);
}

std::optional<std::string> KernelStore::load(const CacheKey& key) const {
  std::vector<fs::path> folders{folder_};
  folders.insert(folders.end(), installed_.begin(), installed_.end());
  for (const fs::path& folder : folders) {
    const fs::path file = folder / name(key);
    CheckedRead read = read_checked_file(file, key);
    if (read.payload) return std::move(read.payload);
    if (!read.problem.empty()) {
      warn(fmt::format("compiled kernels '{}': {}; not used", file.string(), read.problem));
    }
  }
  return std::nullopt;
}

bool KernelStore::store(const CacheKey& key, std::string_view kernels) const {
  const std::string problem = write_checked_file(file(key), key, kernels);
  if (problem.empty()) return true;
  warn(fmt::format("compiled kernels are not kept in '{}': {}", folder_.string(), problem));
  return false;
}

}  // namespace photile::device
