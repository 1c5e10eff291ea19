#include "common/input_file.hpp"

#include <fmt/format.h>

#include <fstream>

#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile {

std::string why_no_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_regular_file(status)) return {};
  if (std::filesystem::exists(status)) return "is not a regular file; name one";
  const bool absent = !error || error == std::errc::no_such_file_or_directory;
  return absent ? "no such file; check the path" : "cannot be read: " + error.message();
}

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
