// A file that appears under its name only when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace photile {

/// Written under a temporary name in the folder of its target, then renamed by `commit`. Destroyed
/// without a commit, it leaves nothing behind and an earlier file under the name untouched. What a
/// killed process leaves behind is removed by the next that writes into the folder.
class OutputFile {
 public:
  /// Opens the temporary file. A symbolic link is followed, so that the link stays one.
  /// Errors: OutputError when the folder cannot be written, or when the name belongs to something
  /// that is no regular file (a folder, a device). UsageError: those of refuse_input.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Bytes to the storage device, then under the final name.
  /// Errors: OutputError naming the file and the reason, also for any earlier write that failed.
  void commit();

  /// Throws the OutputError of this file: the first failed write's reason, or else `reason`.
  [[noreturn]] void fail(const std::string& reason) const;

  /// At the place of the last write's end, or that of `seek`. Does nothing after a failure: what
  /// encoders cannot report is reported by `commit`.
  void write(const void* bytes, std::size_t count);
  std::uint64_t place() const { return place_; }
  void seek(std::uint64_t place) { place_ = place; }
  /// Whether a write has failed.
  bool failed() const { return write_error_ != 0; }

 private:
  std::filesystem::path file_;       ///< as the user named it, for messages
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty once renamed
  int descriptor_ = -1;
  std::uint64_t place_ = 0;
  int write_error_ = 0;  ///< errno of the first failed write
};

/// Writes a file whole. Errors: those of OutputFile.
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace photile
