// HTML pages as PDF, and files within pages.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace photile::report {

/// The page as PDF, on the paper that its style names, by WeasyPrint in a process of its own
/// (Debian's package weasyprint). Errors: OutputError where it is missing or fails.
std::string pdf_of(const std::string& html);

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
