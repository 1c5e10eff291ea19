#include "tools/command/output_files.hpp"

#include <fmt/format.h>

#include <set>

#include "common/output_file.hpp"
#include "photile/errors.hpp"

namespace photile::app {

void check_outputs(std::span<const std::filesystem::path> outputs,
                   const std::filesystem::path& input) {
  std::set<std::filesystem::path> seen;
  for (const auto& output : outputs) {
    std::error_code ignored;  // files that do not exist are told apart by name
    if (std::filesystem::equivalent(output, input, ignored)) {
      throw UsageError(
          fmt::format("{}: is the input, too; choose another output", output.string()));
    }
    const OutputFile probe(output);
    if (!seen.insert(std::filesystem::weakly_canonical(output)).second) {
      throw UsageError(fmt::format("{}: is named as output twice; remove one", output.string()));
    }
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw OutputError(fmt::format("{}: cannot make this folder; name another", folder.string()));
  }
}

}  // namespace photile::app
