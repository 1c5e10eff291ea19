// What the targets share.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "photile/errors.hpp"
#include "targets.hpp"

namespace photile::test {

/// A folder in memory that lives as long as the process.
class FuzzFolder {
 public:
  FuzzFolder()
      : path_(std::filesystem::path("/dev/shm") / ("photile-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes a file for readers that take a name.
inline std::filesystem::path file_of(const std::string& name, Bytes bytes) {
  static const FuzzFolder folder;
  const std::filesystem::path file = folder.path() / name;
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  return file;
}

/// Whether the reader takes the bytes. Errors: std::logic_error where a refusal is not one line.
template <class Read>
bool accepts(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const std::string line = error.what();
    if (line.empty() || line.find('\n') != std::string::npos) {
      throw std::logic_error("not a line for the user: " + line);
    }
    return false;
  }
}

inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace photile::test
