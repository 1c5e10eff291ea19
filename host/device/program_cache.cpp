#include "device/program_cache.hpp"

#include <fmt/format.h>

#include "device/cache_folder.hpp"
#include "device/checked_file.hpp"

namespace photile::device {

ProgramCache::ProgramCache(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code ignored;  // storing will say so
  std::filesystem::create_directories(folder_, ignored);
}

std::filesystem::path ProgramCache::file(const CacheKey& key) const {
  return folder_ / (key.hex() + ".program");
}

std::optional<std::string> ProgramCache::load(const CacheKey& key) const {
  auto read = read_checked_file(file(key), key);
  if (!read.problem.empty()) {
    warn(fmt::format("compiled program '{}': {}; compiling again", file(key).string(),
                     read.problem));
  }
  return std::move(read.payload);
}

void ProgramCache::store(const CacheKey& key, const std::string& binary) const {
  const auto problem = write_checked_file(file(key), key, binary);
  if (!problem.empty()) {
    warn(fmt::format("compiled programs are not kept in '{}': {}", folder_.string(), problem));
  }
}

}  // namespace photile::device
