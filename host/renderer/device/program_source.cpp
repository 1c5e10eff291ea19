#include "device/program_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>

#include "common/files.hpp"
#include "device/context.hpp"
#include "device/embedded_files.hpp"
#include "photile/errors.hpp"

namespace photile::device {

namespace {

struct Registry {
  std::mutex mutex;
  std::map<std::string, std::string> texts;
};

Registry& registry() {
  static Registry registered;
  return registered;
}

std::optional<std::string> registered_source(const std::string& name) {
  const std::lock_guard lock(registry().mutex);
  const auto found = registry().texts.find(name);
  return found == registry().texts.end() ? std::nullopt : std::optional(found->second);
}

/// The folder of kernel_folder_variable, "" = none. Errors: UsageError where it holds no kernel: a
/// mistyped one would pass for a copy that changes nothing.
std::filesystem::path kernel_folder() {
  const char* const folder = std::getenv(kernel_folder_variable);
  if (folder == nullptr || *folder == '\0') return {};
  const auto has = [&](std::string_view name) {
    std::error_code ignored;  // what cannot be looked at holds nothing
    return std::filesystem::is_regular_file(std::filesystem::path(folder) / name, ignored);
  };
  for (const auto& file : embedded_files()) {
    if (has(file.path)) return folder;
  }
  const std::lock_guard lock(registry().mutex);
  for (const auto& [name, text] : registry().texts) {
    if (has(name)) return folder;
  }
  throw UsageError(
      fmt::format("{}: the folder {} holds no kernel files such as {}; give a copy of kernels/",
                  kernel_folder_variable, folder, embedded_files().front().path));
}

std::optional<std::string> source_in_folder(const std::string& name) {
  const std::filesystem::path folder = kernel_folder();
  if (folder.empty()) return std::nullopt;
  std::ifstream file(folder / name, std::ios::binary);
  if (!file) return std::nullopt;
  note_input(folder / name);
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

std::optional<std::string> embedded_source(const std::string& name) {
  for (const auto& file : embedded_files()) {
    if (file.path == name) return std::string(file.text);
  }
  return std::nullopt;
}

std::optional<std::string> find_source(const std::string& name) {
  if (auto text = source_in_folder(name)) return text;
  if (auto text = registered_source(name)) return text;
  return embedded_source(name);
}

std::string_view without_leading_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// What follows `#<name>` on a line, or none.
std::optional<std::string_view> directive(std::string_view line, std::string_view name) {
  line = without_leading_blanks(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = without_leading_blanks(line.substr(1));
  if (!line.starts_with(name)) return std::nullopt;
  return without_leading_blanks(line.substr(name.size()));
}

/// The path of an `#include "path"` line, or none.
std::optional<std::string> included_path(std::string_view line) {
  const auto rest = directive(line, "include");
  if (!rest || !rest->starts_with('"')) return std::nullopt;
  const auto end = rest->find('"', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(rest->substr(1, end - 1));
}

/// Puts included files in the place of their first #include lines.
class Assembler {
 public:
  void add(const std::string& name, const std::string& includer) {
    if (!included_.insert(name).second) return;
    const auto text = find_source(name);
    if (!text) {
      throw KernelBuildError(fmt::format("there is no kernel file '{}'{}", name, includer), {}, 0);
    }
    output_ += fmt::format("#line 1 \"{}\"\n", name);
    std::istringstream lines(*text);
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      if (const auto path = included_path(line)) {
        add(*path, fmt::format(" (included by '{}' line {})", name, number));
        output_ += fmt::format("#line {} \"{}\"\n", number + 1, name);
      } else if (directive(line, "pragma").value_or("").starts_with("once")) {
        output_ += '\n';  // a main file's would be warned of
      } else {
        output_ += line + '\n';
      }
    }
  }
  std::string take() { return std::move(output_); }

 private:
  std::set<std::string> included_;
  std::string output_;
};

}  // namespace

std::string assemble_source(const std::string& file) {
  Assembler assembler;
  assembler.add(file, "");
  return assembler.take();
}

void register_kernel_source(const std::string& name, std::string text) {
  const std::lock_guard lock(registry().mutex);
  registry().texts[name] = std::move(text);
}

Defines& Defines::set(std::string name, long long value) {
  entries_.emplace_back(std::move(name), std::to_string(value));
  return *this;
}

Defines& Defines::set(std::string name, double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) {
    throw DeviceError(fmt::format("definition {} = {} is not a finite float", name, value));
  }
  // {} gives the shortest digits that read back as the same float.
  std::string literal = fmt::format("{}", single);
  if (literal.find_first_of(".e") == std::string::npos) literal += ".0";
  entries_.emplace_back(std::move(name), literal + "f");
  return *this;
}

Defines& Defines::set(std::string name) {
  entries_.emplace_back(std::move(name), "1");
  return *this;
}

std::string Defines::options() const {
  std::string text;
  for (const auto& [name, value] : entries_) {
    if (!text.empty()) text += ' ';
    text += fmt::format("-D {}={}", name, value);
  }
  return text;
}

}  // namespace photile::device
