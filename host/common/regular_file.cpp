#include "common/regular_file.hpp"

namespace photile {

std::string why_no_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_regular_file(status)) return {};
  if (std::filesystem::exists(status)) return "is not a regular file; name one";
  const bool absent = !error || error == std::errc::no_such_file_or_directory;
  return absent ? "no such file; check the path" : "cannot be read: " + error.message();
}

}  // namespace photile
