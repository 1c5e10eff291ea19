// HTML pages as PDF.
#pragma once

#include <filesystem>
#include <string>

namespace photile::report {

/// The page as PDF, on the paper that its style names, by WeasyPrint in a process of its own
/// (Debian's package weasyprint). Errors: OutputError where it is missing or fails.
std::string pdf_of(const std::string& html);

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
