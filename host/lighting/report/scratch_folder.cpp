#include "report/scratch_folder.hpp"

#include <stdlib.h>

#include <string>

#include "photile/errors.hpp"

namespace photile::report {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "photile-XXXXXX").string();
  if (!mkdtemp(name.data())) {
    throw OutputError(name +
                      ": cannot make a temporary folder; set TMPDIR to one that can be written");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace photile::report
