// The scene file and the files that it names, read without leaving the scene's folder, and warnings
// about them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/foreign_text.hpp"
#include "photile/limits.hpp"

namespace photile::files {

/// A texture, buffer or material library cannot be used. `what()` names the file and the reason;
/// the importer decides whether to go on with a warning or to fail.
struct ResourceError : std::runtime_error {
  explicit ResourceError(const std::string& message) : std::runtime_error(one_line(message)) {}
};

/// Warnings, grouped so that a hundred materials with the same problem give one line.
class Warnings {
 public:
  /// A warning about the whole file.
  void add(const std::string& message);

  /// A warning about one object: `kind` is "material", "node", ... Objects of one kind with the
  /// same message share a line.
  void add(const std::string& kind, const std::string& name, const std::string& message);

  /// One line each, in the order in which they were first met.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string kind, message;
    std::vector<std::string> first_names;
    std::set<std::string> names;
  };
  std::vector<Entry> entries_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;  ///< by kind and message
};

/// The bytes of a regular file. Errors: ResourceError with the reason, without the name; those of
/// note_input.
std::vector<unsigned char> read_regular_file(const std::filesystem::path& file,
                                             std::uint64_t max_bytes);

/// The folder of a scene file. A scene is untrusted data: it may name only regular files in its own
/// folder, below the limits of limits.hpp. Names are checked after symbolic links have been
/// resolved and before anything is opened.
class SceneFolder {
 public:
  /// `allow_outside`: files outside the folder may be read too.
  SceneFolder(std::filesystem::path scene_file, bool allow_outside);

  /// The bytes of the scene file itself. Errors: InputError.
  std::vector<unsigned char> read_scene_file() const;

  /// The bytes of a file that the scene names, relative to its folder, '/' between folders.
  ///   most   bytes
  /// Errors: ResourceError when it is missing, outside, no regular file or too large.
  std::vector<unsigned char> read(const std::string& name,
                                  std::uint64_t most = limits::max_file_bytes);

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
