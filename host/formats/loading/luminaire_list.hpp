// The entries of a file of luminaires, as they stand there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace photile::loading {

/// Members keep their order and their numbers: what is not edited is written as it was read.
/// What they mean is read by add_luminaires.
struct LuminaireList {
  std::vector<nlohmann::ordered_json> entries;
  bool alone = false;  ///< one object in place of a list

  bool operator==(const LuminaireList&) const = default;

  /// JSON, an entry a line.
  std::string text() const;

  ///   name   of the file, for messages
  /// Errors: InputError where it is no JSON, or neither an object nor a list.
  static LuminaireList parse(const std::string& text, const std::string& name);
};

/// Errors: those of parse and read_input_text.
LuminaireList read_luminaires(const std::filesystem::path& file);
/// The same of a file that the run may write; one that does not exist holds no entry yet.
LuminaireList read_own_luminaires(const std::filesystem::path& file);

/// Through a temporary name and a rename. Errors: OutputError; the file is then as it was.
void write_luminaires(const std::filesystem::path& file, const LuminaireList& list);

}  // namespace photile::loading
