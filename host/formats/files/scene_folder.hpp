// Reading the scene file and the files it names, without being led elsewhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace photile::files {

/// The bytes of a regular file. Errors: ResourceError with the reason, without the name; those of
/// note_input.
std::vector<unsigned char> read_regular_file(const std::filesystem::path& file,
                                             std::uint64_t max_bytes);

/// The folder of a scene file. A scene is data from strangers: it may name only regular files in
/// its own folder, below the limits of limits.hpp. Names are checked after symbolic links have been
/// resolved and before anything is opened.
class SceneFolder {
 public:
  /// `allow_outside`: files outside the folder may be read too.
  SceneFolder(std::filesystem::path scene_file, bool allow_outside);

  /// The bytes of the scene file itself. Errors: InputError.
  std::vector<unsigned char> read_scene_file() const;

  /// The bytes of a file that the scene names, relative to its folder, '/' between folders.
  /// Errors: ResourceError when it is missing, outside, no regular file or too large.
  std::vector<unsigned char> read(const std::string& name);

  /// Whether there is such a file that may be read.
  bool holds(const std::string& name) const;

  const std::filesystem::path& scene_file() const { return scene_file_; }

 private:
  std::filesystem::path resolve(const std::string& name) const;

  std::filesystem::path scene_file_;
  bool allow_outside_;
  std::uint64_t external_bytes_ = 0;
};

}  // namespace photile::files
