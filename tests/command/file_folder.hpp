// A temporary folder and the files in it.
#pragma once

#include <cstddef>
#include <string>

#include "temporary_folder.hpp"

namespace photile::test {

struct FileFolder : TemporaryFolder {
  /// Path of `name` in the folder.
  std::string operator/(const std::string& name) const { return (path / name).string(); }

  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  /// Content of a file.
  std::string read(const std::string& name) const;
  /// How many files there are.
  std::size_t file_count() const;
};

}  // namespace photile::test
