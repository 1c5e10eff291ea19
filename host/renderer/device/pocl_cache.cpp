#include "device/pocl_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "common/files.hpp"
#include "device/cache_folder.hpp"
#include "photile/errors.hpp"

namespace photile::device {

namespace {

namespace fs = std::filesystem;

constexpr const char* variable = "POCL_CACHE_DIR";
constexpr const char* lock_name = "lock";
constexpr const char* folder_prefix = "pocl-run-";

/// Locks `folder`/lock until the descriptor is closed or the process dies. -1 where it is held, or
/// has gone. A file system without locks counts as locked for the owner, as held for a cleaner.
int lock_folder(const fs::path& folder, bool create) {
  const int flags = O_RDWR | O_CLOEXEC | (create ? O_CREAT : 0);
  const int file = ::open((folder / lock_name).c_str(), flags, 0600);
  if (file < 0) return -1;
  const bool locked = ::flock(file, create ? LOCK_EX : LOCK_EX | LOCK_NB) == 0;
  struct stat status {};
  // A cleaner that came between our open and our lock has unlinked the file meanwhile.
  const bool exists = ::fstat(file, &status) == 0 && status.st_nlink > 0;
  if (exists && (locked || create)) return file;
  ::close(file);
  return -1;
}

/// Removes what killed processes left behind.
void remove_stale_folders(const fs::path& base) {
  std::error_code error;
  for (fs::directory_iterator entry(base, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->path().filename().string().starts_with(folder_prefix)) continue;
    const int lock = lock_folder(entry->path(), false);
    if (lock < 0) continue;
    std::error_code ignored;
    fs::remove_all(entry->path(), ignored);
    ::close(lock);
  }
}

/// The folder of this process. Its destructor runs at exit, when PoCL is no longer used.
class WorkFolder {
 public:
  WorkFolder() {
    if (user_folder_usable()) return;
    std::error_code error;
    if (const auto cache = persistent_cache_folder()) create_in(*cache);
    if (folder_.empty()) create_in(fs::temp_directory_path(error));
    if (folder_.empty()) {
      throw DeviceError(fmt::format(
          "no folder for compiled kernels: neither the user's cache folder nor '{}' can be written "
          "with {} MiB free; set XDG_CACHE_HOME or TMPDIR to another folder",
          fs::temp_directory_path(error).string(), min_free_cache_bytes >> 20));
    }
    ::setenv(variable, folder_.c_str(), 1);
  }
  ~WorkFolder() {
    // A forked child shares the lock and must not take its parent's folder away.
    if (folder_.empty() || ::getpid() != owner_) return;
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    ::close(lock_);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const fs::path& path() const { return folder_; }

 private:
  /// PoCL takes an empty value for a folder and ends the process.
  static bool user_folder_usable() {
    const char* const value = std::getenv(variable);
    if (value == nullptr || *value == '\0') return false;
    const auto problem = folder_problem(value);
    if (problem.empty()) return true;
    warn(fmt::format("{} '{}' cannot be used ({}); using photile's own folder", variable, value,
                     problem));
    return false;
  }

  void create_in(const fs::path& base) {
    if (!folder_problem(base).empty()) return;
    remove_stale_folders(base);
    std::string name = (base / folder_prefix).string() + "XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) return;
    lock_ = lock_folder(name, true);
    if (lock_ >= 0) folder_ = name;
  }

  fs::path folder_;
  int lock_ = -1;
  pid_t owner_ = ::getpid();
};

}  // namespace

const fs::path& pocl_work_folder() {
  static const WorkFolder folder;
  return folder.path();
}

namespace {

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
  const auto [entry, is_new] = programs_.try_emplace(key, Program{key});
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
    for (auto& [key, program] : programs_) {
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
