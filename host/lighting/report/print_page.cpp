#include "report/print_page.hpp"

#include <stdlib.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "common/output_file.hpp"
#include "photile/errors.hpp"

namespace photile::report {

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
