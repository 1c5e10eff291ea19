#include "report/printing.hpp"

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <system_error>

#include "photile/errors.hpp"

namespace photile::report {

std::string base64(std::string_view bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t byte = 0; byte < 3; ++byte) {
      bits = bits << 8 | (byte < count ? static_cast<unsigned char>(bytes[i + byte]) : 0u);
    }
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? digits[bits >> (18 - 6 * digit) & 63u] : '=';
    }
  }
  return text;
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "photile-XXXXXX").string();
  if (!mkdtemp(name.data())) {
    throw OutputError(name + ": cannot create a temporary folder; set TMPDIR to a writable folder");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace photile::report
