#include "device/cache_folder.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "common/foreign_text.hpp"
#include "device/embedded_files.hpp"
#include "device/kernel_store.hpp"

namespace photile::device {

namespace {

namespace fs = std::filesystem;

/// The value of an environment variable where it is an absolute path; XDG says to ignore others.
std::optional<fs::path> folder_from_environment(const char* variable) {
  const char* const value = std::getenv(variable);
  if (value == nullptr || value[0] != '/') return std::nullopt;
  return fs::path(value);
}

/// Permissions do not bind root and do not know of quotas: only a write tells.
bool can_write(const fs::path& folder) {
  std::string name = (folder / "probe-XXXXXX").string();
  const int file = ::mkstemp(name.data());
  if (file < 0) return false;
  const bool written = ::write(file, "x", 1) == 1;
  ::close(file);
  ::unlink(name.c_str());
  return written;
}

}  // namespace

std::string folder_problem(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return error.message();
  struct statvfs system {};
  if (::statvfs(folder.c_str(), &system) != 0) return std::strerror(errno);
  if (system.f_flag & ST_NOEXEC) return "mounted noexec";
  const auto free_bytes = static_cast<std::uint64_t>(system.f_bavail) * system.f_frsize;
  if (free_bytes < min_free_cache_bytes) {
    return fmt::format("{} MiB free, {} MiB needed", free_bytes >> 20, min_free_cache_bytes >> 20);
  }
  return can_write(folder) ? "" : "not writable";
}

std::optional<fs::path> persistent_cache_folder() {
  if (const auto base = folder_from_environment("XDG_CACHE_HOME")) {
    if (const auto folder = *base / "photile"; folder_problem(folder).empty()) return folder;
  }
  if (const auto home = folder_from_environment("HOME")) {
    if (const auto folder = *home / ".cache" / "photile"; folder_problem(folder).empty()) {
      return folder;
    }
  }
  return std::nullopt;
}

std::vector<fs::path> installed_kernel_folders() {
  const char* const value = std::getenv("XDG_DATA_DIRS");
  std::istringstream list(value == nullptr || *value == '\0' ? "/usr/local/share:/usr/share"
                                                             : value);
  std::vector<fs::path> folders;
  for (std::string base; std::getline(list, base, ':');) {
    const fs::path folder = fs::path(base) / "photile" / "kernels";
    std::error_code ignored;  // a folder that cannot be read holds nothing
    if (folder.is_absolute() && fs::is_directory(folder, ignored)) folders.push_back(folder);
  }
  return folders;
}

void warn(const std::string& line) {
  // One call, so that the lines of several processes do not mix.
  const std::string text = "photile: warning: " + one_line(line) + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

namespace {

/// All kernels together: when any of them changes, the test has to be run again.
const std::string& all_kernels() {
  static const std::string text = [] {
    std::vector<EmbeddedFile> files(embedded_files().begin(), embedded_files().end());
    std::sort(files.begin(), files.end(),
              [](const EmbeddedFile& a, const EmbeddedFile& b) { return a.path < b.path; });
    std::string joined;
    for (const EmbeddedFile& file : files) joined.append(file.path).append(file.text);
    return joined;
  }();
  return text;
}

CacheKey key_of(const DeviceInfo& device) {
  return program_key(device, "device test", all_kernels());
}

std::optional<KernelStore> results() {
  const auto folder = persistent_cache_folder();
  if (!folder) return std::nullopt;
  return KernelStore(*folder / "kernels", {}, ".test");
}

}  // namespace

std::string kept_test_result(const DeviceInfo& device) {
  const auto store = results();
  return store ? store->load(key_of(device)).value_or("") : "";
}

void keep_test_result(const DeviceInfo& device, const std::string& result) {
  if (const auto store = results()) {
    store->store(key_of(device), result);
  } else {
    warn("the result of the device test is not stored; set XDG_CACHE_HOME to a writable folder");
  }
}

}  // namespace photile::device
