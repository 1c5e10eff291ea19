// Output files, checked before the long work.
#pragma once

#include <filesystem>
#include <span>

namespace photile::app {

/// Makes sure that `outputs` can be written, by creating and removing a temporary file beside each.
/// Errors: OutputError naming the one that cannot; UsageError where one is named twice or is
/// `input`.
void check_outputs(std::span<const std::filesystem::path> outputs,
                   const std::filesystem::path& input);

/// Makes a folder for outputs, and those above it. Errors: OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace photile::app
