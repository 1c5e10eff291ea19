// Where the sources are, and the scenes in them. A function in a file of its own: a compiler cache
// serves all other files to a copy of the sources elsewhere.
#pragma once

#include <filesystem>

namespace photile::test {

/// The folder of README.md.
std::filesystem::path source_folder();

}  // namespace photile::test
