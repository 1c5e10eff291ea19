// A temporary folder and the files in it.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "file_bytes.hpp"
#include "temporary_folder.hpp"

namespace photile::test {

struct FileFolder : TemporaryFolder {
  /// Path of `name` in the folder.
  std::string operator/(const std::string& name) const { return (path / name).string(); }

  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    return put(path / name, text).string();
  }
  /// Content of a file.
  std::string read(const std::string& name) const { return bytes_of(path / name); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(read(name)); }
  /// How many files there are.
  std::size_t file_count() const {
    const auto begin = std::filesystem::directory_iterator(path);
    return static_cast<std::size_t>(std::distance(begin, {}));
  }
};

}  // namespace photile::test
