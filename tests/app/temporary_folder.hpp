// A folder that lives as long as a test.
#pragma once

#include <filesystem>
#include <string>

namespace photile::test {

class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Path of `name` in the folder.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  /// Content of a file.
  std::string read(const std::string& name) const;
  /// How many files there are.
  std::size_t file_count() const;

 private:
  std::filesystem::path path_;
};

}  // namespace photile::test
