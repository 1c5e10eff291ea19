// Which files a run reads and which it writes, so that no run overwrites what it reads.
#pragma once

#include <filesystem>

namespace photile {

/// Lives as long as a run of the command; there is one at a time. A program that calls the library
/// may write what it has read: without a RunFiles the functions below do nothing.
class RunFiles {
 public:
  RunFiles();
  ~RunFiles();
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;
};

/// For whoever reads a file that the user named, or that such a file names. One that does not exist
/// is not noted. Errors: UsageError naming both where it is an output of the run.
void note_input(const std::filesystem::path& file);

/// For each file that the run is to write, as early as its name is known.
/// Errors: UsageError naming both where it is an input of the run or another output.
void note_output(const std::filesystem::path& file);

/// Before any file is opened for writing. Errors: UsageError where it is an input of the run.
void refuse_input(const std::filesystem::path& file);

/// The file that a name stands for: symbolic links are followed, also to what does not exist yet.
/// Absolute.
std::filesystem::path target_of(const std::filesystem::path& file);

}  // namespace photile
