// A folder for files of a moment.
#pragma once

#include <filesystem>

namespace photile::report {

/// Among the system's temporary files; removed with what it holds at the end.
class ScratchFolder {
 public:
  /// Errors: OutputError.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace photile::report
