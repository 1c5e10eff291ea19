#include "common/input_text.hpp"

#include <fmt/format.h>

#include <fstream>

#include "common/regular_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

std::string read_input_text(const std::filesystem::path& file) {
  note_input(file);
  return read_own_text(file);
}

std::string read_own_text(const std::filesystem::path& file) {
  if (const std::string reason = why_no_regular_file(file); !reason.empty()) {
    throw InputError(fmt::format("{}: {}", file.string(), reason));
  }
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error || bytes > limits::max_input_text_bytes) {
    throw InputError(fmt::format("{}: larger than {} bytes; split it", file.string(),
                                 limits::max_input_text_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(bytes, '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw InputError(fmt::format("{}: cannot be read", file.string()));
  }
  return text;
}

}  // namespace photile
