#include "command/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "common/ascii_text.hpp"

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

void print_line(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

void print_error(const std::string& message) {
  const char* prefix = use_color() ? "photile: \033[1;31merror:\033[0m " : "photile: error: ";
  print_line(prefix + one_line(message));
}

}  // namespace photile::app
