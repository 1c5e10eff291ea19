// Files of a run, checked before the long work: outputs that can be written and are no input.
#pragma once

#include <filesystem>
#include <span>

namespace photile::app {

struct RenderOptions;

/// Notes the files that these options name to be read. What those name in turn is noted when it is
/// read. Errors: those of note_input.
void note_inputs_of(const RenderOptions& options);

/// Notes `outputs` and makes sure that they can be written, by creating and removing a temporary
/// file beside each.
/// Errors: OutputError naming the one that cannot; those of note_output.
void check_outputs(std::span<const std::filesystem::path> outputs);

/// Makes a folder for outputs, and those above it. Errors: OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace photile::app
