// Output files, checked before the long work and written whole.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace photile::app {

/// Makes sure that `outputs` can be written, by creating and removing a temporary file beside each.
/// Errors: OutputError naming the one that cannot; UsageError where one is named twice or is
/// `input`.
void check_outputs(std::span<const std::filesystem::path> outputs,
                   const std::filesystem::path& input);

/// Writes `text` to a temporary name and renames it. Errors: OutputError.
void write_text_file(const std::filesystem::path& file, const std::string& text);

}  // namespace photile::app
