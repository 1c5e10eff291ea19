// Text files that say where to measure or to look from.
#pragma once

#include <filesystem>
#include <string>

namespace photile {

/// The whole content. Errors: InputError naming the file where it is missing, unreadable, no
/// regular file or larger than limits::max_input_text_bytes; those of note_input.
std::string read_input_text(const std::filesystem::path& file);

/// The same for a file that the run may write again: it is not noted as an input.
std::string read_own_text(const std::filesystem::path& file);

}  // namespace photile
