// Whether a name is one of a file that can be read.
#pragma once

#include <filesystem>
#include <string>

namespace photile {

/// What keeps it from being one, with the remedy: "no such file; check the path", "is not a regular
/// file; name one". "" where nothing does.
std::string why_no_regular_file(const std::filesystem::path& file);

}  // namespace photile
