// Text files that say where to measure or to look from.
#pragma once

#include <filesystem>
#include <string>

namespace photile {

/// The whole content. Errors: InputError naming the file where it is missing, unreadable, no
/// regular file or larger than limits::max_input_text_bytes.
std::string read_input_text(const std::filesystem::path& file);

}  // namespace photile
