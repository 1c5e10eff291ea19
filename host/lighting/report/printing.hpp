// Files within pages, and folders for what is on its way.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace photile::report {

/// RFC 4648, for files within a page.
std::string base64(std::string_view bytes);

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
