#include "device/kernel_dump.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "common/files.hpp"
#include "device/program.hpp"
#include "device/program_source.hpp"
#include "photile/errors.hpp"

namespace photile::device {

void dump_program(const std::string& file, const std::string& options, cl_program program) {
  const char* const variable = std::getenv(dump_folder_variable);
  if (variable == nullptr || *variable == '\0') return;
  const std::filesystem::path folder = variable;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: {}", folder.string(), error.message()));

  std::string name = file.substr(0, file.rfind('.'));
  std::replace(name.begin(), name.end(), '/', '-');
  const std::filesystem::path path =
      folder / fmt::format("{}-{:08x}", name, XXH32(options.data(), options.size(), 0));
  write_file(path.string() + ".cl", assemble_source(file));
  write_file(path.string() + ".options", options + "\n");
  if (const auto binary = program_binary(program)) write_file(path.string() + ".bin", *binary);
}

}  // namespace photile::device
