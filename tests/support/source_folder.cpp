#include "source_folder.hpp"

namespace photile::test {

std::filesystem::path source_folder() { return PHOTILE_SOURCE_DIR; }

}  // namespace photile::test
