#include "report/printing.hpp"

#include <stdlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <system_error>

#include "common/files.hpp"
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

namespace {

/// In quotes for the shell.
std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string pdf_of(const std::string& html) {
  const ScratchFolder folder;
  const std::filesystem::path page = folder.path() / "page.html";
  write_file(page, html);
  const std::string command = "weasyprint " + quoted(page.string()) + " - 2> /dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw OutputError("cannot start weasyprint; write .html, and print that");
  std::string pdf;
  std::array<char, 1 << 16> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    pdf.append(buffer.data(), count);
  }
  if (pclose(pipe) != 0 || !pdf.starts_with("%PDF")) {
    throw OutputError(
        "weasyprint cannot print the page; install Debian's package weasyprint, or write .html and "
        "print that");
  }
  return pdf;
}

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
