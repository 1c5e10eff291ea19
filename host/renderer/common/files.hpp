// Files that a run reads and writes: whether they can be read, outputs that appear under their
// names when they are complete, and no output over an input.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/foreign_text.hpp"
#include "photile/errors.hpp"

namespace photile {

/// The reason why a file cannot be read, with the remedy: "no such file; check the path", "is not a
/// regular file; name one". "" where it can be read.
std::string why_no_regular_file(const std::filesystem::path& file);

/// The whole content. Errors: InputError naming the file where it is missing, unreadable, not a
/// regular file or larger than limits::max_input_text_bytes; those of note_input.
std::string read_input_text(const std::filesystem::path& file);

/// The content of a file that the run may write again: it is not noted as an input.
std::string read_own_text(const std::filesystem::path& file);

/// Adds the file's name to errors of `work` about the content of a file, or about what is requested
/// of it; without a file, errors stay as they are.
template <class Work>
auto about_file(const std::filesystem::path& file, const Work& work) {
  const auto named = [&](const std::string& what) {
    const std::string name = one_line(file.string()) + ": ";
    return file.empty() || what.starts_with(name) ? what : name + what;
  };
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(named(error.what()));
  } catch (const UsageError& error) {
    throw UsageError(named(error.what()));
  }
}

/// Written under a temporary name in the folder of its target, then renamed by `commit`. Destroyed
/// without a commit, it leaves nothing behind and an earlier file under the name untouched. What a
/// killed process leaves behind is removed by the next process that writes into the folder.
class OutputFile {
 public:
  /// Opens the temporary file. A symbolic link is followed, so that the link stays one.
  /// Errors: OutputError when the folder cannot be written, or when the name is that of something
  /// other than a regular file (a folder, a device). UsageError: those of refuse_input.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Flushes the bytes to the storage device, then gives the file its final name.
  /// Errors: OutputError naming the file and the reason, also for any earlier write that failed.
  void commit();

  /// Throws the OutputError of this file: the first failed write's reason, or else `reason`.
  [[noreturn]] void fail(const std::string& reason) const;

  /// Writes at the end of the last write, or at the position of `seek`. Does nothing after a
  /// failure: what encoders cannot report is reported by `commit`.
  void write(const void* bytes, std::size_t count);
  std::uint64_t position() const { return position_; }
  void seek(std::uint64_t position) { position_ = position; }
  /// Whether a write has failed.
  bool failed() const { return write_error_ != 0; }

 private:
  std::filesystem::path file_;       ///< as the user named it, for messages
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty once renamed
  int descriptor_ = -1;
  std::uint64_t position_ = 0;
  int write_error_ = 0;  ///< errno of the first failed write
};

/// Writes a file whole. Errors: those of OutputFile.
void write_file(const std::filesystem::path& file, std::string_view content);

/// Lives as long as a run of the command; there is one at a time. A program that calls the library
/// may write what it has read: without a RunFiles the functions below do nothing.
class RunFiles {
 public:
  RunFiles();
  ~RunFiles();
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;
};

/// To be called by code that reads a file named by the user, or by such a file. A file that does
/// not exist is not noted. Errors: UsageError naming both where it is an output of the run.
void note_input(const std::filesystem::path& file);

/// For each file that the run is to write, as early as its name is known.
/// Errors: UsageError naming both where it is an input of the run or another output.
void note_output(const std::filesystem::path& file);

/// Before any file is opened for writing. Errors: UsageError where it is an input of the run.
void refuse_input(const std::filesystem::path& file);

/// The absolute path of the file that a name refers to: symbolic links are followed, even to what
/// does not exist yet.
std::filesystem::path target_of(const std::filesystem::path& file);

}  // namespace photile
