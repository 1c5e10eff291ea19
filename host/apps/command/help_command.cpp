#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "command/command_line.hpp"
#include "command/processes.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "scene/light_names.hpp"

namespace photile::app {
namespace {

/// Pages of the documentation by topic: "guide/render", and "guide" of the index of a folder.
std::map<std::string, std::filesystem::path> help_pages() {
  std::map<std::string, std::filesystem::path> pages;
  const std::filesystem::path docs = folder_of_program(PHOTILE_INSTALLED_PAGES, "docs");
  for (const std::string folder : {"guide", "kernels", "method", "reference"}) {
    if (!std::filesystem::is_directory(docs / folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(docs / folder)) {
      const std::filesystem::path& file = entry.path();
      if (file.extension() != ".md") continue;
      pages[file.stem() == "README" ? folder : folder + "/" + file.stem().string()] = file;
    }
  }
  return pages;
}

/// The page without the marks of its generated tables.
std::string page_text(const std::filesystem::path& file) {
  const std::string page = read_own_text(file);
  std::string text;
  for (const std::string_view line : lines_of(page)) {
    if (!line.starts_with("<!--")) text.append(line) += '\n';
  }
  return text;
}

/// To a terminal through the program that the environment's PAGER names.
void show(const std::string& text) {
  const char* const pager = std::getenv("PAGER");
  if (pager == nullptr || *pager == '\0' || isatty(STDOUT_FILENO) == 0) {
    std::cout << text;
    return;
  }
  FILE* const pipe = popen(pager, "w");
  std::signal(SIGINT, SIG_IGN);  // it is the pager's
  if (pipe != nullptr) std::fwrite(text.data(), 1, text.size(), pipe);
  if (pipe == nullptr || WEXITSTATUS(pclose(pipe)) == 127) {
    throw OutputError(fmt::format("PAGER: cannot start '{}'", pager));
  }
}

void run_help(CLI::App& photile, const std::string& topic) {
  const auto pages = help_pages();
  std::string text;
  if (topic.empty()) {
    // App::help would print that of this command.
    text = photile.get_formatter()->make_help(&photile, "photile", CLI::AppFormatMode::Normal);
    if (!pages.empty()) text += "\nPages:\n";
    for (const auto& [name, file] : pages) {
      const std::string page = page_text(file);
      text += fmt::format("  {:<27} {}\n", name, page.substr(2, page.find('\n') - 2));
    }
    return show(text + "\nphotile help TOPIC prints the help of a command, or a page\n");
  }
  std::set<std::string> names;
  std::vector<std::string> others;
  for (CLI::App* command : photile.get_subcommands([](CLI::App*) { return true; })) {
    names.insert(command->get_name());
    // One that prints its own help.
    if (command->get_name() == topic && !command->get_help_ptr()) return command->parse("--help");
    if (command->get_name() == topic) text = command->help("photile");
  }
  for (const auto& [name, file] : pages) {
    names.insert(name.substr(name.find('/') + 1));
    if (name != topic && !name.ends_with("/" + topic)) continue;
    if (text.empty()) {
      text = page_text(file);
    } else {
      others.push_back("photile help " + name);
    }
  }
  if (text.empty()) {
    throw UsageError(fmt::format("help: no topic '{}'; there {}; photile help lists all", topic,
                                 scene::names_like(topic, {names.begin(), names.end()}, 3)));
  }
  if (!others.empty()) text += fmt::format("\nSee also: {}\n", fmt::join(others, ", "));
  show(text);
}

}  // namespace

void add_help_command(CLI::App& photile) {
  auto topic = std::make_shared<std::string>();
  CLI::App* command =
      photile.add_subcommand("help", "Print the help of a command, or a page of the documentation");
  command->add_option("TOPIC", *topic, "a command or a page; default: list them")->type_name("");
  command->callback([&photile, topic] { run_help(photile, *topic); });
}

}  // namespace photile::app
