#include "device/pocl_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/files.hpp"
#include "device/cache_folder.hpp"

namespace photile::device {
namespace {

namespace fs = std::filesystem;

/// PoCL's folders of programs, "XX/name" below its work folder.
std::set<fs::path> program_folders(const fs::path& work) {
  std::set<fs::path> found;
  for (const auto& group : fs::directory_iterator(work)) {
    if (!group.is_directory()) continue;
    for (const auto& program : fs::directory_iterator(group)) {
      if (program.is_directory()) found.insert(program.path());
    }
  }
  return found;
}

/// The files of a program that a later run can use: dates of use and leftovers of the compiler are
/// not among them.
std::vector<fs::path> useful_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    const bool useful = name == "program.bc" || name == "build.log" || name.extension() == ".so";
    if (entry.is_regular_file() && useful) files.push_back(entry.path());
  }
  return files;
}

/// Writes a file that is not there: PoCL may have mapped one that is. Errors: std::runtime_error.
void write_new_file(const fs::path& path, const std::vector<std::uint8_t>& content) {
  if (fs::exists(path)) return;
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(content.data()),
             static_cast<std::streamsize>(content.size()));
  file.close();
  if (file) return;
  fs::remove(path);  // PoCL ends the process on a truncated file
  throw std::runtime_error("cannot write '" + path.string() + "'");
}

}  // namespace

PoclCache::PoclCache(fs::path work, KernelStore store)
    : work_(std::move(work)), store_(std::move(store)) {}

void PoclCache::restore(Program& program) const {
  const std::optional<std::string> pack = store_.load(program.key);
  if (!pack) return;
  try {
    const auto files = nlohmann::json::from_cbor(*pack);
    for (const auto& [name, content] : files.items()) {
      write_new_file(work_ / name, content.get_binary());
      const fs::path path(name);  // "XX/name/...", below the program's folder
      program.folder = work_ / *path.begin() / *std::next(path.begin());
    }
    program.stored_files = files.size();
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels '{}' cannot be restored: {}",
                     store_.file(program.key).string(), error.what()));
  }
}

bool PoclCache::build(const CacheKey& key, const std::function<void()>& build) {
  const std::lock_guard lock(mutex_);
  const auto [entry, is_new] = programs_.try_emplace(key.hex(), Program{key});
  if (is_new) restore(entry->second);

  const auto before = program_folders(work_);
  build();
  const auto after = program_folders(work_);
  const auto added = std::find_if(after.begin(), after.end(),
                                  [&](const fs::path& folder) { return !before.contains(folder); });
  if (added == after.end()) return true;
  entry->second.folder = *added;
  entry->second.stored_files = 0;
  return false;
}

void PoclCache::publish() noexcept {
  try {
    const std::lock_guard lock(mutex_);
    for (auto& [name, program] : programs_) {
      if (program.folder.empty()) continue;
      const std::vector<fs::path> files = useful_files(program.folder);
      if (files.size() == program.stored_files) continue;
      nlohmann::json pack;
      for (const fs::path& file : files) {
        const std::string content = read_own_text(file);
        pack[file.lexically_relative(work_).string()] =
            nlohmann::json::binary({content.begin(), content.end()});
      }
      const std::vector<std::uint8_t> text = nlohmann::json::to_cbor(pack);
      if (!store_.store(program.key, {reinterpret_cast<const char*>(text.data()), text.size()})) {
        return;
      }
      program.stored_files = files.size();
    }
  } catch (const std::exception& error) {
    warn(fmt::format("compiled kernels are not kept: {}", error.what()));
  }
}

}  // namespace photile::device
