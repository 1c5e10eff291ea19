#include "device/pocl_work_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

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
          "with {} MiB free; set XDG_CACHE_HOME or TMPDIR to one that can",
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
    warn(fmt::format("{} '{}' cannot be used ({}); using a folder of photile's", variable, value,
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

WorkFolder& work_folder() {
  static WorkFolder folder;
  return folder;
}

}  // namespace

void prepare_pocl_work_folder() { work_folder(); }

std::optional<fs::path> pocl_work_folder() {
  const auto& path = work_folder().path();
  return path.empty() ? std::nullopt : std::optional(path);
}

}  // namespace photile::device
