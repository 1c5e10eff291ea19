// A file that appears under its name only when it is complete.
#pragma once

#include <OpenImageIO/filesystem.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace photile {

/// Written under a temporary name in the folder of its target, then renamed by `commit`. Destroyed
/// without a commit, it leaves nothing behind and an earlier file under the name untouched. It is
/// an OpenImageIO proxy, so encoders write through it and every short write is noticed.
class OutputFile : public OIIO::Filesystem::IOProxy {
 public:
  /// Opens the temporary file. A symbolic link is followed, so that the link stays one.
  /// Errors: OutputError when the folder cannot be written, or when the name belongs to something
  /// that is no regular file (a folder, a device). UsageError: those of refuse_input.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Bytes to the storage device, then under the final name.
  /// Errors: OutputError naming the file and the reason, also for any earlier write that failed.
  void commit();

  /// Throws the OutputError of this file: the first failed write's reason, or else `reason`.
  [[noreturn]] void fail(const std::string& reason) const;

  /// Where the bytes go until `commit`, for an encoder that opens files by name.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// As `fail`, after such an encoder has failed: finds out whether the storage device is full.
  [[noreturn]] void fail_on_behalf(const std::string& reason) const;

  const char* proxytype() const override { return "file"; }
  std::size_t write(const void* bytes, std::size_t count) override;
  std::size_t pwrite(const void* bytes, std::size_t count, std::int64_t offset) override;
  bool seek(std::int64_t offset) override;
  std::size_t size() const override;

 private:
  [[noreturn]] void fail_with(int error, const std::string& reason) const;

  std::filesystem::path file_;       ///< as the user named it, for messages
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty once renamed
  int descriptor_ = -1;
  int write_error_ = 0;  ///< errno of the first failed write
};

/// Writes a file whole. Errors: those of OutputFile.
void write_file(const std::filesystem::path& file, std::string_view content);

}  // namespace photile
