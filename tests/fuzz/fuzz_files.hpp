// What the targets share.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "photile/errors.hpp"
#include "targets.hpp"
#include "test_scenes.hpp"

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

/// A floor of two triangles with a lamp above.
inline Scene lit_floor() {
  SceneBuilder builder("floor");
  builder.grid(glm::vec3(0.0f), {1, 0, 0}, {0, 1, 0}, 1, builder.add(diffuse(0.5f)));
  builder.add(point_light("lamp", {0.4f, 0.5f, 0.7f}));
  return builder.build();
}

/// Writes a file for readers that take a name, over what the last input left there: its memory
/// stays.
inline std::filesystem::path file_of(const std::string& name, Bytes bytes) {
  static const FuzzFolder folder;
  const std::filesystem::path file = folder.path() / name;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const bool written =
      descriptor >= 0 &&
      ::write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) &&
      ::ftruncate(descriptor, static_cast<off_t>(bytes.size())) == 0;
  if (descriptor >= 0) ::close(descriptor);
  if (!written) throw std::runtime_error(file.string() + " cannot be written");
  return file;
}

/// Whether the reader takes the bytes. Errors: std::logic_error where a refusal is not one line
/// that names the file, if one is given.
template <class Read>
bool accepts(const Read& read, const std::filesystem::path& file = {}) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const std::string line = error.what();
    if (line.empty() || line.find('\n') != std::string::npos ||
        line.find(file.filename().string()) == std::string::npos) {
      throw std::logic_error("not a line for the user: " + line);
    }
    return false;
  }
}

inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace photile::test
