#include "common/input_text.hpp"

#include <fmt/format.h>

#include <fstream>

#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

std::string read_input_text(const std::filesystem::path& file) {
  note_input(file);
  return read_own_text(file);
}

std::string read_own_text(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(fmt::format("{}: no such file", file.string()));
  }
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
