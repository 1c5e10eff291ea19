// Damaged scene files: each has to be a sound scene or an InputError of one line that names the
// file.
#pragma once

#include <catch2/catch.hpp>
#include <random>
#include <string>

#include "scene_files.hpp"
#include "scene_invariants.hpp"

namespace photile::test {

/// Loads them one after the other in a folder of their own, and counts.
class DamagedFiles {
 public:
  /// A file beside them.
  void write(const std::string& name, const std::string& content) { folder_.write(name, content); }

  void load(const std::string& name, const std::string& content) {
    std::string error;
    try {
      check_invariants(load_scene(folder_.write(name, content)));
      ++loaded;
      return;
    } catch (const InputError& refusal) {
      error = refusal.what();
    }
    ++refused;
    CAPTURE(error);
    CHECK(error.find(name) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
  }

  int loaded = 0, refused = 0;

 private:
  SceneFolderOnDisk folder_;
};

/// The text with up to eight bytes replaced.
inline std::string with_replaced_bytes(std::string text, std::mt19937& random) {
  for (unsigned changes = 1 + random() % 8; changes > 0; --changes) {
    text[random() % text.size()] = static_cast<char>(random());
  }
  return text;
}

}  // namespace photile::test
