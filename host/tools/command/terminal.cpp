#include "tools/command/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace photile::app {
namespace {

bool use_color() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  return stderr_is_terminal() && !dumb && (no_color == nullptr || *no_color == '\0');
}

}  // namespace

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

int terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

std::string single_line(std::string line) {
  while (!line.empty() && line.back() == '\n') line.pop_back();
  for (char& character : line) {
    const auto code = static_cast<unsigned char>(character);
    if (code < 0x20 || code == 0x7f) character = ' ';
  }
  return line;
}

void print_line(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

void print_error(const std::string& message) {
  const char* prefix = use_color() ? "photile: \033[1;31merror:\033[0m " : "photile: error: ";
  print_line(prefix + single_line(message));
}

}  // namespace photile::app
