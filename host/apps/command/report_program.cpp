#include "command/report_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <optional>
#include <utility>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/processes.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "report/printing.hpp"

extern char** environ;

namespace photile::app {
namespace {

namespace fs = std::filesystem;

/// Isolated: neither the working folder nor the environment names modules that it loads.
///   errors   file for what it prints
/// Returns the exit code, or none where a signal ended it. Errors: OutputError where it does not
/// start.
std::optional<int> run_python(std::vector<std::string> arguments, const fs::path& errors) {
  const std::string python = python_program();
  arguments.insert(arguments.begin(), {python, "-I", "-B", python_package() / "report"});
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, 2, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  // Signals as any program has them: this one blocks those that stop it.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  for (const int signal : {SIGINT, SIGTERM, SIGXFSZ}) sigaddset(&usual, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, python.c_str(), &files, &attributes, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) {
    throw OutputError(
        "Python, which writes reports, plans, UGR tables and Honeybee's files, is missing: apt-get "
        "install python3-jinja2 python3-contourpy");
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? std::optional(WEXITSTATUS(status)) : std::nullopt;
}

/// Runs photile.report on a record. Errors: what it says, as an error of its kind; Interrupted.
///   folder   for files on the way
void run_program(const nlohmann::ordered_json& record, const fs::path& folder,
                 std::vector<std::string> arguments) {
  const fs::path results = folder / "results.json", errors = folder / "errors";
  write_file(results, json_text(record, -1));
  arguments.push_back(results.string());
  const std::optional<int> code = run_python(std::move(arguments), errors);
  if (code == 0) return;
  throw_if_stop_requested();
  // What it does not expect is a trace of calls, whose last line says what it was.
  const std::string printed = read_own_text(errors);
  const auto lines = lines_of(printed);
  std::string said = lines.empty() ? "" : one_line(lines.back());
  const std::string head = "photile.report: error: ";
  if (said.starts_with(head)) said.erase(0, head.size());
  if (said.empty()) said = "photile.report was killed; try again";
  if (code == static_cast<int>(ExitCode::usage)) throw UsageError(said);
  if (code == static_cast<int>(ExitCode::input)) throw InputError(said);
  throw OutputError(said);
}

void add_template(const ReportOptions& options, std::vector<std::string>& arguments) {
  if (options.templates.empty()) return;
  arguments.insert(arguments.end(), {"--template", options.templates});
}

}  // namespace

fs::path python_package() {
  fs::path folder = folder_of_program(PHOTILE_INSTALLED_PYTHON, "python/photile");
  if (fs::exists(folder / "__main__.py")) return folder;
  throw OutputError(folder.string() +
                    ": photile's Python files are missing; install photile again");
}

std::string python_program() {
  return fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
}

void add_template_option(const OptionGroup& group, ReportOptions& options) {
  group.add("--template", options.templates, "FOLDER",
            "your own templates for reports and plans: style.css, report.html, plan.svg");
}

bool is_plan(const std::string& file) { return ends_in(file, ".svg") || ends_in(file, ".dxf"); }

std::vector<std::string> drawn_files(const std::vector<std::string>& files) {
  std::vector<std::string> drawn;
  for (const std::string& file : files) {
    if (ends_in(file, ".html") || ends_in(file, ".pdf") || is_plan(file)) drawn.push_back(file);
  }
  return drawn;
}

std::vector<fs::path> plan_names(const fs::path& file, std::size_t plans) {
  if (plans <= 1) return std::vector(plans, file);
  std::vector<fs::path> names;
  for (std::size_t i = 1; i <= plans; ++i) {
    names.push_back(file);
    names.back().replace_filename(
        fmt::format("{}-{}{}", file.stem().string(), i, file.extension().string()));
  }
  return names;
}

void check_report(ReportOptions& options, const std::vector<std::string>& files) {
  options.included = nlohmann::ordered_json::array();
  for (const std::string& file : options.results) {
    note_input(file);
    options.included.push_back({{"file", file}, {"content", read_input_json(file)}});
  }
  const std::vector<std::string> drawn = drawn_files(files);
  if (drawn.empty() || !leads()) return;
  std::vector<std::string> arguments{"--check"};
  for (const std::string& file : drawn) {
    arguments.insert(arguments.end(), {"-o", "report" + fs::path(file).extension().string()});
  }
  const report::ScratchFolder folder;
  add_template(options, arguments);
  run_program({{"report", {{"language", options.language}, {"included", options.included}}}},
              folder.path(), std::move(arguments));
}

void draw_report(const nlohmann::ordered_json& record, const ReportOptions& options,
                 const std::vector<std::string>& files, std::size_t plans) {
  const std::vector<std::string> drawn = drawn_files(files);
  if (drawn.empty()) return;
  const report::ScratchFolder folder;
  std::vector<std::string> arguments;
  const auto scratch = [&](const std::string& file) {
    return folder.path() / ("report" + lower(fs::path(file).extension().string()));
  };
  for (const std::string& file : drawn) {
    arguments.insert(arguments.end(), {"-o", scratch(file).string()});
  }
  add_template(options, arguments);
  run_program(record, folder.path(), std::move(arguments));
  for (const std::string& file : drawn) {
    const std::size_t count = is_plan(file) ? plans : 1;
    const auto from = plan_names(scratch(file), count), to = plan_names(file, count);
    for (std::size_t i = 0; i < count; ++i) write_file(to[i], read_own_text(from[i]));
  }
}

std::string write_ugr_table(const nlohmann::ordered_json& luminaire,
                            const std::vector<std::string>& files) {
  const report::ScratchFolder folder;
  const auto scratch = [&](const std::string& ending) {
    return (folder.path() / ("table" + ending)).string();
  };
  run_program(
      luminaire, folder.path(),
      {"--ugr-table", "-o", scratch(".txt"), "-o", scratch(".csv"), "-o", scratch(".json")});
  for (const std::string& file : files) {
    write_file(file, read_own_text(scratch(lower(fs::path(file).extension().string()))));
  }
  return read_own_text(scratch(".txt"));
}

void check_honeybee() {
  if (!leads()) return;
  const report::ScratchFolder folder;
  run_program({}, folder.path(), {"--check", "--honeybee", folder.path().string()});
}

void write_honeybee(const fs::path& folder,
                    const std::function<nlohmann::ordered_json(const fs::path&)>& record_of) {
  const report::ScratchFolder scratch;
  run_program(record_of(scratch.path()), scratch.path(), {"--honeybee", folder.string()});
}

std::vector<measuring::RatedObserver> observers_in(const nlohmann::ordered_json& included) {
  std::vector<measuring::RatedObserver> observers;
  for (const auto& result : included) {
    const auto& content = result.at("content");
    if (!content.contains("observers")) continue;
    for (const auto& observer : content.at("observers")) {
      const auto &rating = observer.at("ugr"), &place = observer.at("position");
      if (rating.is_null()) continue;
      observers.push_back({observer.at("name"),
                           {place.at(0), place.at(1), place.at(2)},
                           {rating.at("value"), rating.at("standard_error")}});
    }
  }
  return observers;
}

}  // namespace photile::app
