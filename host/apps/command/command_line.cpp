#include "command/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include "command/processes.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "common/process_limits.hpp"
#include "device/program.hpp"

namespace photile::app {
namespace {

void define(CLI::App& photile) {
  photile.set_version_flag("--version", version_text());
  photile.require_subcommand(1);
  for (AddCommand* const add :
       {add_import_command,   add_render_command,   add_relight_command,  add_compare_command,
        add_measure_command,  add_daylight_command, add_glare_command,    add_outlook_command,
        add_layout_command,   add_trade_command,    add_devices_command,  add_info_command,
        add_settings_command, add_ies_command,      add_validate_command, add_walk_command,
        add_trace_command,    add_view_command,     add_bake_command,     add_publish_command,
        add_help_command}) {
    add(photile);
  }
  for (CLI::App* command : photile.get_subcommands([](CLI::App*) { return true; })) {
    const std::string name = command->get_name();
    if (name == "render" || name == "measure" || name == "walk") continue;
    command->preparse_callback(
        [name](std::size_t) { refuse_several("photile " + name, "start it without mpirun"); });
  }
}

/// The command whose --help explains a usage error.
std::string help_command(const CLI::App& photile) {
  const auto chosen = photile.get_subcommands();
  return chosen.empty() ? "photile --help" : "photile " + chosen.front()->get_name() + " --help";
}

/// Whether standard output is a pipe whose reader has closed it, as `head` does.
bool nobody_reads_on() {
  pollfd output{STDOUT_FILENO, 0, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

/// Standard output may be a file on a full disk: what was lost there is an error, too.
void flush_standard_output() {
  std::cout.flush();
  if (!std::cout && !nobody_reads_on())
    throw OutputError("standard output: cannot write (disk full?)");
}

/// Refuses options with an empty value. For CLI11 `--stats=` has none, and takes the next word,
/// which may be the name of a file that must not be overwritten.
void refuse_empty_values(std::span<const char* const> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    const bool ends_empty = word.starts_with("--") && word.find('=') == word.size() - 1;
    if (!word.empty() && !ends_empty) continue;
    std::string_view option = word.substr(0, word.size() - std::min<std::size_t>(1, word.size()));
    if (word.empty() && i > 0 && std::string_view(arguments[i - 1]).starts_with('-')) {
      option = arguments[i - 1];
    }
    if (option.empty()) throw UsageError("an argument is empty; give it a value, or leave it out");
    throw UsageError(
        fmt::format("{}: the value is empty; give one, or leave the option out", option));
  }
}

/// CLI11 speaks of "At Most 1 required but received 2" where an option is repeated.
std::string words_of(const CLI::ArgumentMismatch& error) {
  const std::string text = error.what();
  const std::size_t at = text.find(": At Most 1 required but received ");
  if (at == std::string::npos) return text;
  return fmt::format("{} is given {} times; give it once", text.substr(0, at),
                     text.substr(text.rfind(' ') + 1));
}

ExitCode parse_and_run(CLI::App& photile, int argument_count, const char* const* arguments) {
  refuse_empty_values({arguments + 1, static_cast<std::size_t>(std::max(argument_count, 1) - 1)});
  try {
    photile.parse(argument_count, arguments);
  } catch (const CLI::ExtrasError&) {
    // CLI11 lists them from the last to the first.
    const std::vector<std::string> extra = photile.remaining(true);
    for (std::size_t i = 0; i < extra.size(); ++i) {
      const std::string remedy =
          remedy_for_option(extra[i], i + 1 < extra.size() ? extra[i + 1] : std::string());
      if (!remedy.empty()) throw UsageError(remedy + "; photile settings lists all");
    }
    throw UsageError(fmt::format("{} not expected: {}; see {}",
                                 extra.size() > 1 ? "these arguments were" : "this argument was",
                                 fmt::join(extra, " "), help_command(photile)));
  } catch (const CLI::ArgumentMismatch& error) {
    throw UsageError(fmt::format("{}; see {}", words_of(error), help_command(photile)));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
      throw UsageError(std::string(error.what()) + "; see " + help_command(photile));
    }
    std::ostringstream unread;
    // Prints the help or the version that was asked for.
    photile.exit(error, leads() ? std::cout : unread, leads() ? std::cerr : unread);
  }
  flush_standard_output();
  return ExitCode::success;
}

/// Ends the run of all processes, and prints the error of the first that failed. Returns the exit
/// code of all.
int conclude(ExitCode code, const std::string& problem) {
  const auto own = static_cast<int>(code);
  if (!processes()) {
    if (code != ExitCode::success) print_error(problem);
    return own;
  }
  // A launcher that ends all does not wait until they agree.
  const bool told = code == ExitCode::interrupted && leads() && stop_requested();
  if (told) print_error(problem);
  const auto tell = [&] {
    if (!told) print_error(problem);
  };
  return processes()->conclude(own, tell).code;
}

/// Without allocating memory, which joining strings would.
[[noreturn]] void end_in_runtime(std::string_view line) {
  static_cast<void>(::write(STDERR_FILENO, line.data(), line.size()) == 0);
  ::_exit(static_cast<int>(ExitCode::device));
}

[[noreturn]] void end_in_compiler() {
  end_in_runtime(
      "photile: error: out of memory in the compiler of a device; raise the limit on address space "
      "(ulimit -v)\n");
}

/// Compilers of devices abort in states that they do not handle (docs/kernels/runtimes.md).
void end_where_a_compiler_aborts() {
  device::handle_aborts_by([](int) {
    end_in_runtime(
        "photile: error: the device's runtime ended the program; choose another device (--device), "
        "or another version of the runtime\n");
  });
}

/// No exception may pass through PoCL: in a thread of photile it would leave locks held, so that
/// all threads wait for ever; in a thread of PoCL it ends the process by a signal.
void end_where_a_compiler_lacks_memory() {
  std::set_new_handler([] {
    if (device::in_compiler()) end_in_compiler();
    throw std::bad_alloc();
  });
  std::set_terminate([] {
    try {
      if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
      end_in_compiler();
    } catch (...) {
    }
    std::abort();
  });
}

}  // namespace

int run_command_line(int argument_count, const char* const* arguments) {
  ExitCode code = ExitCode::failure;
  std::string problem;
  const TerminalText names_command_nothing(std::cout);
  end_where_a_compiler_lacks_memory();
  end_where_a_compiler_aborts();
  std::signal(SIGPIPE, SIG_IGN);  // a reader that closes the pipe early does not end the rendering
  try {
    require_stack();
    join_processes({arguments, static_cast<std::size_t>(argument_count)});
    CLI::App photile("Photon mapping on OpenCL devices, a layer of the picture per light.",
                     "photile");
    define(photile);
    const RunFiles files;
    code = parse_and_run(photile, argument_count, arguments);
  } catch (const SettingError& error) {
    problem = option_of(error.setting) + ": " + error.problem;
    code = exit_code_of(error);
  } catch (const Error& error) {
    problem = error.what();
    code = exit_code_of(error);
  } catch (const std::bad_alloc&) {
    problem = "out of memory; render fewer photons, fewer pixels or a smaller scene";
  } catch (const std::exception& error) {
    problem = std::string("internal error: ") + error.what();
  }
  return conclude(code, problem);
}

}  // namespace photile::app
