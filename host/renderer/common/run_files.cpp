#include "common/run_files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "photile/errors.hpp"

namespace photile {
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
          ? fmt::format("{}: is an input of this run, too; choose another output", output)
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
