#include "common/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

std::string why_no_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_regular_file(status)) return {};
  if (std::filesystem::exists(status)) return "is not a regular file; name one";
  const bool absent = !error || error == std::errc::no_such_file_or_directory;
  return absent ? "no such file; check the path" : "cannot be read: " + error.message();
}

std::string read_input_text(const std::filesystem::path& file) {
  note_input(file);
  return read_own_text(file);
}

std::string read_own_text(const std::filesystem::path& file) {
  if (const std::string reason = why_no_regular_file(file); !reason.empty()) {
    throw InputError(fmt::format("{}: {}", file.string(), reason));
  }
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error || bytes > limits::max_input_text_bytes) {
    throw InputError(fmt::format("{}: larger than {} bytes; split it", file.string(),
                                 limits::max_input_text_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(bytes, '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  }
  return text;
}

namespace {

namespace fs = std::filesystem;

/// A rename lasts only once the folder that holds the name is on the storage device.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder may be writable without being readable
  ::fsync(descriptor);
  ::close(descriptor);
}

/// The prefix of the names of temporary files. 16 random hexadecimal digits follow: process numbers
/// are the same in two containers, and a name of the longest length has no room for more.
constexpr std::string_view prefix = ".photile.";

bool is_temporary(std::string_view name) {
  return name.starts_with(prefix) && name.size() == prefix.size() + 16 &&
         name.find_first_not_of("0123456789abcdef", prefix.size()) == std::string_view::npos;
}

std::string temporary_name() {
  std::random_device random;
  return fmt::format("{}{:08x}{:08x}", prefix, random(), random());
}

/// Removes the temporary files in a folder that no process holds: those of killed runs. A lock says
/// so across machines and containers, where process numbers mean nothing.
void remove_abandoned(const fs::path& folder) {
  static std::mutex mutex;
  // A walk writes thousands of files into one folder. Never destroyed: a Device that is static
  // keeps its kernels when the process ends.
  static auto& done = *new std::set<fs::path>;
  const std::lock_guard lock(mutex);
  if (!done.insert(fs::absolute(folder).lexically_normal()).second) return;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_temporary(entry->path().filename().string())) continue;
    const int file = ::open(entry->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(file);
  }
}

/// A new file that is locked until it is closed, or its process ends; -1 with errno.
int create_locked(const fs::path& file) {
  for (;;) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    ::flock(descriptor, LOCK_EX);  // without locks in the file system no run removes it either
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || status.st_nlink > 0) return descriptor;
    ::close(descriptor);  // another run has found it before it was locked
  }
}

}  // namespace

OutputFile::OutputFile(const fs::path& file) : file_(file), target_(target_of(file)) {
  refuse_input(file);
  struct stat status {};
  const bool found = ::stat(target_.c_str(), &status) == 0;
  if (!found && errno == ELOOP) {
    throw OutputError(
        fmt::format("{}: is a symbolic link to itself; name an output file", file.string()));
  }
  if (!found && errno == ENAMETOOLONG) {
    throw OutputError(
        fmt::format("{}: the file name is too long; give a shorter one", file.string()));
  }
  if (found && !S_ISREG(status.st_mode)) {
    throw OutputError(fmt::format("{}: is not a regular file; name an output file", file.string()));
  }
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  remove_abandoned(folder);
  do {
    temporary_ = folder / temporary_name();
    descriptor_ = create_locked(temporary_);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) {
    throw OutputError(fmt::format("{}: cannot be created: {}; choose a writable folder",
                                  file.string(), std::strerror(errno)));
  }
  // Those who cannot read the old one are not to read the new one meanwhile.
  if (found) ::fchmod(descriptor_, S_IRUSR | S_IWUSR);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::fail(const std::string& reason) const {
  const int error = write_error_;
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw OutputError(fmt::format("{}: cannot be written: {}{}", file_.string(),
                                error != 0 ? std::strerror(error) : reason,
                                full ? "; free space or choose another folder" : ""));
}

void OutputFile::commit() {
  if (write_error_ != 0) fail("");
  struct stat replaced {};
  if (::stat(target_.c_str(), &replaced) == 0) ::fchmod(descriptor_, replaced.st_mode & 0777);
  if (::fsync(descriptor_) != 0) fail(std::strerror(errno));
  // Network file systems report a full disk only here.
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(std::strerror(errno));
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(std::strerror(errno));
  temporary_.clear();
  sync_folder(target_.has_parent_path() ? target_.parent_path() : fs::path("."));
}

void OutputFile::write(const void* bytes, std::size_t count) {
  std::size_t written = 0;
  while (written < count && write_error_ == 0) {
    const ssize_t result = ::pwrite(descriptor_, static_cast<const char*>(bytes) + written,
                                    count - written, static_cast<off_t>(position_ + written));
    if (result > 0) {
      written += static_cast<std::size_t>(result);
    } else if (result == 0 || errno != EINTR) {
      write_error_ = result == 0 ? ENOSPC : errno;
    }
  }
  position_ += written;
}

void write_file(const fs::path& file, std::string_view content) {
  OutputFile output(file);
  output.write(content.data(), content.size());  // a short write is reported by commit
  output.commit();
}

namespace {

namespace fs = std::filesystem;

using Inode = std::pair<dev_t, ino_t>;

std::optional<Inode> inode_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return Inode{status.st_dev, status.st_ino};
}

/// Files under the names that the user knows them by. Hard links have one inode; files that do not
/// exist yet have only names.
class FileSet {
 public:
  const std::string* find(const fs::path& file) const {
    if (const auto inode = inode_of(file)) {
      const auto found = by_inode_.find(*inode);
      if (found != by_inode_.end()) return &found->second;
    }
    const auto found = by_name_.find(target_of(file));
    return found == by_name_.end() ? nullptr : &found->second;
  }

  void add(const fs::path& file) {
    if (const auto inode = inode_of(file)) by_inode_.emplace(*inode, file.string());
    by_name_.emplace(target_of(file), file.string());
  }

 private:
  std::map<Inode, std::string> by_inode_;
  std::map<fs::path, std::string> by_name_;
};

struct Run {
  FileSet inputs, outputs;
};

std::mutex mutex;  // textures may be read by several threads
std::optional<Run> run;

[[noreturn]] void refuse(const std::string& output, const std::string& input) {
  throw UsageError(
      output == input
          ? fmt::format("{}: is also an input of this run; choose another output", output)
          : fmt::format("{}: is the same file as {}, an input of this run; choose another output",
                        output, input));
}

}  // namespace

RunFiles::RunFiles() {
  const std::lock_guard lock(mutex);
  run.emplace();
}

RunFiles::~RunFiles() {
  const std::lock_guard lock(mutex);
  run.reset();
}

void note_input(const fs::path& file) {
  const std::lock_guard lock(mutex);
  if (!run || !inode_of(file)) return;
  if (const std::string* output = run->outputs.find(file)) refuse(*output, file.string());
  run->inputs.add(file);
}

void note_output(const fs::path& file) {
  refuse_input(file);
  const std::lock_guard lock(mutex);
  if (!run) return;
  if (const std::string* other = run->outputs.find(file)) {
    throw UsageError(
        fmt::format("{}: is named as output twice, also as {}; remove one", file.string(), *other));
  }
  run->outputs.add(file);
}

void refuse_input(const fs::path& file) {
  const std::lock_guard lock(mutex);
  if (!run) return;
  if (const std::string* input = run->inputs.find(file)) refuse(file.string(), *input);
}

fs::path target_of(const fs::path& file) {
  constexpr int most_links = 40;  // as Linux follows
  std::error_code error;
  fs::path target = fs::absolute(file, error);
  if (error) return file;
  for (int link = 0; link < most_links && fs::is_symlink(target, error); ++link) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) return file;
    target = target.parent_path() / next;  // an absolute one replaces the whole
  }
  const fs::path canonical = fs::weakly_canonical(target, error);
  return error ? target : canonical;
}

}  // namespace photile
