// Commands that are programs of photile's Python package. They have options and help of their own:
// whatever stands behind the command's name is handed on.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/report_program.hpp"
#include "photile/errors.hpp"

namespace photile::app {
namespace {

namespace fs = std::filesystem;

/// That of an active virtual environment, in which pip puts what Debian lacks, or that of reports.
std::string python_of_user() {
  const char* const environment = std::getenv("VIRTUAL_ENV");
  const fs::path own = fs::path(environment == nullptr ? "" : environment) / "bin/python3";
  return own.is_absolute() && fs::exists(own) ? own.string() : python_program();
}

/// The program takes the place of this one. Errors: OutputError where it cannot be started.
[[noreturn]] void run_in_python(std::vector<std::string> arguments) {
  const std::string python = python_of_user();
  arguments.insert(arguments.begin(), {python, "-B", python_package().string()});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  // Layouts are measured by this very program.
  ::setenv("PHOTILE_COMMAND", fs::read_symlink("/proc/self/exe").c_str(), 1);
  ::execvp(python.c_str(), pointers.data());
  throw OutputError(fmt::format("{}: cannot be started: {}; apt-get install python3 python3-numpy",
                                python, std::strerror(errno)));
}

void add_python_command(CLI::App& photile, const std::string& name, const std::string& does) {
  CLI::App* command = photile.add_subcommand(name, does);
  command->set_help_flag();
  command->prefix_command();
  command->callback([command, name] {
    std::vector<std::string> arguments = command->remaining();
    arguments.insert(arguments.begin(), name);
    run_in_python(std::move(arguments));
  });
}

}  // namespace

void add_import_command(CLI::App& photile) {
  add_python_command(photile, "import",
                     "Import a building of IFC or Honeybee with its rooms, or luminaires of GLDF");
}

void add_layout_command(CLI::App& photile) {
  add_python_command(photile, "layout", "Place luminaires in a room so that they meet a target");
}

void add_outlook_command(CLI::App& photile) {
  add_python_command(photile, "outlook", "Rate the view out and the hours of sun by EN 17037");
}

}  // namespace photile::app
